import { useEffect, useMemo } from 'preact/hooks';
import { jobs as api, newRequestId } from '../../api/services';
import type { Job, JobInput } from '../../api/types';
import { beginnings } from '../../events';
import { withLabel } from '../../model/fields';
import { formatSeconds } from '../../model/units';
import { againPath, go } from '../../route';
import { canRetry, forget, isFinished, known, queue, refresh, remember } from '../../state/jobs';
import { orNotify, say } from '../../state/notices';
import { may, mayChange } from '../../state/session';
import { secondsUntil } from '../../ui/clock';
import { Button, ConfirmButton, Check } from '../../ui/controls';
import { JobProgress, kindOf, kindText, numberOf, State, When } from '../../ui/job_text';
import { WarningLines } from '../../ui/warning';
import { CalibrateView } from './calibrate_view';
import { CaptureView } from './capture_view';
import { DipView } from './dip_view';
import { Files, Pictures } from './files';
import { pagesOf } from './pages';
import { PlanBody, PlanOf } from './plan_body';
import { Results } from './results';
import { SimulateView } from './simulate_view';

export function JobScreen({ name }: { name: string }) {
  useEffect(() => void refresh(name), [name, beginnings.value]);
  const job = known.value.get(name);
  if (!job)
    return (
      <>
        <h1>Job {numberOf(name)}</h1>
        <p class="quiet">
          Loading… If nothing appears, the job may not exist; see{' '}
          <a href="#/jobs">the list of jobs</a>.
        </p>
      </>
    );
  return (
    <article class="job">
      <Head job={job} />
      {isFinished(job) ? <Left job={job} key={job.state} /> : <Underway job={job} />}
    </article>
  );
}

function Head({ job }: { job: Job }) {
  return (
    <header>
      <h1>
        {job.displayName || job.name} <State state={job.state} waitsFor={job.waitsFor} />
      </h1>
      <p class="quiet">
        Job {numberOf(job.name)}, {kindText(job)}, by {job.owner}, created{' '}
        <When time={job.createTime} />
        {job.endTime && (
          <>
            , ended <When time={job.endTime} />
          </>
        )}
        {job.cacheHit && ', result of an earlier identical job'}
        <PlanOf job={job} />
        {job.retryOf && (
          <>
            , retry of <a href={`#/${job.retryOf}`}>{numberOf(job.retryOf)}</a>
          </>
        )}
      </p>
      <Actions job={job} />
    </header>
  );
}

function Actions({ job }: { job: Job }) {
  const kind = kindOf(job);
  const isDone = job.state === 'SUCCEEDED';
  const mine = mayChange(job.owner);
  const begin = async (spec: JobInput) => {
    const made = orNotify(await api.create(spec, newRequestId()));
    if (!made) return;
    remember(made);
    go(`/${made.name}`);
  };
  return (
    <div class="row actions">
      {kind === 'simulate' && isDone && may('MAKER') && (
        <Button kind="primary" onPress={() => begin({ printImage: pagesOf(job) })}>
          Create PDF
        </Button>
      )}
      {kind === 'simulate' && isDone && may('OPERATOR') && (
        <a class="button" href={`#/rig?job=${numberOf(job.name)}`}>
          Dip
        </a>
      )}
      {kind === 'printImage' && isDone && may('MAKER') && (
        <Button onPress={() => begin({ print: { printImageJob: job.name } })}>
          Send to the printer
        </Button>
      )}
      {kind === 'simulate' && isDone && may('MAKER') && (
        <Button onPress={() => begin({ template: { simulateJob: job.name } })}>
          Placement template
        </Button>
      )}
      {(kind === 'simulate' || kind === 'plan') && isFinished(job) && may('MAKER') && (
        <a class="button" href={againPath(job.name)}>
          Run again with changes
        </a>
      )}
      {mine && !isFinished(job) && job.state !== 'CANCELLING' && (
        <ConfirmButton
          sure="Confirm cancellation"
          onPress={async () => {
            const cancelled = orNotify(await api.cancel(job.name));
            if (cancelled) remember(cancelled);
          }}
        >
          Cancel
        </ConfirmButton>
      )}
      {mine && canRetry(job) && (
        <Button
          onPress={async () => {
            const again = orNotify(await api.retry(job.name, newRequestId()));
            if (!again) return;
            remember(again);
            go(`/${again.name}`);
          }}
        >
          Retry
        </Button>
      )}
      {mine && isFinished(job) && <Keeping job={job} />}
    </div>
  );
}

/** Sharing and deletion of a finished job. */
function Keeping({ job }: { job: Job }) {
  return (
    <>
      <Check
        label="Shared with everyone"
        value={job.shared}
        onValue={(shared) =>
          void api.share(job.name, shared).then((answer) => {
            const changed = orNotify(answer);
            if (changed) remember(changed);
          })
        }
      />
      <ConfirmButton
        kind="plain"
        sure="Delete job and files"
        onPress={async () => {
          if (!orNotify(await api.remove(job.name))) return;
          forget(job.name);
          say('The job was deleted');
          go('/jobs');
        }}
      >
        Delete
      </ConfirmButton>
    </>
  );
}

function Underway({ job }: { job: Job }) {
  const left = secondsUntil(job.etaTime);
  if (kindOf(job) === 'dip') return <Left job={job} />;
  return (
    <section class="underway" role="status">
      <JobProgress job={job} queue={queue.value} />
      {job.state === 'RUNNING' && left !== undefined && left > 0 && (
        <p class="clock">
          {formatSeconds(Math.ceil(left))}
          <span class="quiet"> left</span>
        </p>
      )}
      <p class="quiet">
        You can leave this page. The job continues, and its result will appear here.
      </p>
    </section>
  );
}

/** Results of the job. */
function Left({ job }: { job: Job }) {
  const results = useMemo(() => new Results(job.name), [job.name]);
  useEffect(() => results.loadReport(), [results, beginnings.value]);
  const failure = results.failure.value;
  return (
    <>
      {job.error && (
        <p class="warning" role="alert">
          {withLabel(job.error.field, job.error.message)}
          <span class="quiet"> {job.error.reason}</span>
        </p>
      )}
      {job.state === 'CANCELLED' && !job.dip && (
        <p class="quiet">
          The job was cancelled and has no results.{' '}
          {mayChange(job.owner) && canRetry(job) && 'You can retry it.'}
        </p>
      )}
      {job.state === 'INTERRUPTED' && (
        <p class="warning">
          The daemon stopped while this job ran. The job does not start again automatically.
        </p>
      )}
      {failure && (
        <p class="warning" role="alert">
          {failure.what}. {failure.remedy}.
        </p>
      )}
      <Body job={job} results={results} />
    </>
  );
}

function Body({ job, results }: { job: Job; results: Results }) {
  switch (kindOf(job)) {
    case 'simulate':
      return job.state === 'SUCCEEDED' ? <SimulateView results={results} /> : null;
    case 'plan':
      return <PlanBody job={job} results={results} />;
    case 'dip':
      return <DipView job={job} results={results} />;
    case 'capture':
      return <CaptureView results={results} />;
    case 'calibrate':
    case 'calibrateCamera':
      return <CalibrateView job={job} results={results} />;
    default:
      return (
        <>
          <WarningLines warnings={results.warnings} />
          <Files results={results} />
          <Pictures results={results} />
        </>
      );
  }
}
