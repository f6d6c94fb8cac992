import { warningsOf } from '../../model/report';
import type { Results } from './results';

/** The warnings of the job's report. */
export const WarningLines = ({ results }: { results: Results }) => (
  <>
    {warningsOf(results.report.value).map(({ code, message, where }) => (
      <p class="warning" key={code + where + message}>
        {message}
        {where && <span class="quiet"> ({where})</span>}
      </p>
    ))}
  </>
);
