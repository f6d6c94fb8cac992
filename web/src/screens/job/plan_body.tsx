import type { ComponentType } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import type { Job } from '../../api/types';
import { jobPath } from '../../route';
import { numberOf } from '../../ui/job_text';
import { Files } from './files';
import type { Results } from './results';
import { WarningLines } from './warning_lines';

type View = ComponentType<{ job: Job }>;

/** A plan of several dips. The code of its page is loaded only when it is needed. */
export function PlanBody({ job, results }: { job: Job; results: Results }) {
  const [view, setView] = useState<{ View: View }>();
  useEffect(() => {
    void import('../plan').then(({ PlanView }) => setView({ View: PlanView }));
  }, []);
  if (job.state !== 'SUCCEEDED') return <Files results={results} />;
  return (
    <>
      {view ? <view.View job={job} /> : <p class="quiet">Loading the dips…</p>}
      <WarningLines results={results} />
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
