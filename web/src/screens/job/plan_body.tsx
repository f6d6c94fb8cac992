import type { Job } from '../../api/types';
import { jobPath } from '../../route';
import { numberOf } from '../../ui/job_text';
import { later } from '../../ui/later';
import { WarningLines } from '../../ui/warning';
import { Files } from './files';
import type { Results } from './results';

const PlanView = later(() => import('../plan').then((plan) => plan.PlanView));

/** A plan of several dips. The code of its page is loaded only when it is needed. */
export function PlanBody({ job, results }: { job: Job; results: Results }) {
  if (job.state !== 'SUCCEEDED') return <Files results={results} />;
  return (
    <>
      <PlanView job={job} />
      <WarningLines warnings={results.warnings} />
      <details>
        <summary>Files of the plan</summary>
        <Files results={results} />
      </details>
    </>
  );
}

/** A link to the plan that the job belongs to. */
export function PlanOf({ job: { simulate, dipStatus } }: { job: Job }) {
  const plan = simulate?.planJob || dipStatus?.planJob;
  if (!plan) return null;
  return (
    <>
      , dip {simulate?.immersion ?? dipStatus?.immersion} of{' '}
      <a href={jobPath(plan)}>plan {numberOf(plan)}</a>
    </>
  );
}
