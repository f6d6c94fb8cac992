import { useEffect, useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { jobs as api, newRequestId, queue as queueApi } from '../../api/services';
import type { Job } from '../../api/types';
import { beginnings } from '../../events';
import { go, jobPath } from '../../route';
import {
  arrivals,
  canRetry,
  isFinished,
  kFinished,
  kOpen,
  known,
  queue,
  remember,
} from '../../state/jobs';
import { orNotify, say } from '../../state/notices';
import { may, mayChange, me } from '../../state/session';
import { Button, Switch, TextField } from '../../ui/controls';
import { JobProgress, kindText, numberOf, State, When } from '../../ui/job_text';

type OwnerFilter = 'mine' | 'all';
type Which = 'all' | 'open' | 'finished';

/** Pages of jobs, newest first, fetched again when jobs arrive. */
function usePages(whose: OwnerFilter, which: Which) {
  const [names, setNames] = useState<string[]>();
  const [next, setNext] = useState('');
  const query = {
    ...(whose === 'mine' ? { owner: me.value } : {}),
    ...(which === 'all' ? {} : { states: which === 'open' ? kOpen : kFinished }),
  };
  const more = async (pageToken: string, before: string[]) => {
    const page = orNotify(await api.list({ ...query, pageToken }));
    if (!page) return;
    remember(...page.jobs);
    setNames([...before, ...page.jobs.map((job) => job.name)]);
    setNext(page.nextPageToken);
  };
  const key = `${whose} ${which} ${me.value}`;
  useEffect(() => setNames(undefined), [key]);
  useEffect(() => {
    const timer = window.setTimeout(() => void more('', []), 50);
    return () => window.clearTimeout(timer);
  }, [key, arrivals.value, beginnings.value]);
  return { names, next, more: () => more(next, names ?? []) };
}

export function QueueScreen() {
  const [whose, setWhose] = useState<OwnerFilter>('all');
  const [which, setWhich] = useState<Which>('all');
  const { names, next, more } = usePages(whose, which);
  const rows = (names ?? []).flatMap((name) => known.value.get(name) ?? []);
  return (
    <div class="queue">
      <h1>Jobs</h1>
      <div class="row">
        <Switch<OwnerFilter>
          label="Owner"
          value={whose}
          onValue={setWhose}
          choices={[
            { value: 'all', label: 'Everyone' },
            { value: 'mine', label: 'Mine' },
          ]}
        />
        <Switch<Which>
          label="State"
          value={which}
          onValue={setWhich}
          choices={[
            { value: 'all', label: 'All' },
            { value: 'open', label: 'Open' },
            { value: 'finished', label: 'Finished' },
          ]}
        />
      </div>
      <Line />
      {names === undefined && <p class="quiet">Loading…</p>}
      {names && rows.length === 0 && (
        <p class="quiet">
          No jobs to show. <a href="#/">Start a new print</a>.
        </p>
      )}
      {rows.length > 0 && <Table rows={rows} />}
      {next && <Button onPress={more}>Older</Button>}
    </div>
  );
}

/** State of the queue, with a button to pause or resume it. */
function Line() {
  const [reason, setReason] = useState('');
  const line = queue.value;
  if (!line) return null;
  const running = line.runningJobs.length;
  return (
    <div class={`line ${line.paused || line.blockedReason ? 'paused' : ''}`}>
      <p>
        {running} of {line.workerSlots} workers are busy; jobs waiting: {line.queuedCount}.
        {line.paused && (
          <strong>
            {' '}
            The queue is paused{line.pauseReason ? `: ${line.pauseReason}` : ''}. Running jobs
            continue; no new jobs start.
          </strong>
        )}
        {!line.paused && line.blockedReason && (
          <strong>
            {' '}
            No job starts now: {line.blockedReason}. Jobs that wait start by themselves.
          </strong>
        )}
      </p>
      {line.confinementWarning && (
        <p class="warning">Workers are not fully confined: {line.confinementWarning}.</p>
      )}
      {may('OPERATOR') &&
        (line.paused ? (
          <Button
            onPress={async () => {
              queue.value = orNotify(await queueApi.resume()) ?? line;
            }}
          >
            Resume
          </Button>
        ) : (
          <details>
            <summary>Pause the queue</summary>
            <TextField
              label="Reason"
              value={reason}
              onValue={setReason}
              placeholder="new film"
              maxBytes={rules.PauseQueueRequest.reason.maxBytes}
            />
            <Button
              onPress={async () => {
                queue.value = orNotify(await queueApi.pause(reason)) ?? line;
              }}
            >
              Pause
            </Button>
          </details>
        ))}
    </div>
  );
}

const Table = ({ rows }: { rows: Job[] }) => (
  <table class="jobs">
    <thead>
      <tr>
        <th scope="col">Job</th>
        <th scope="col">State</th>
        <th scope="col">Owner</th>
        <th scope="col">Created</th>
        <th scope="col">
          <span class="hidden">Actions</span>
        </th>
      </tr>
    </thead>
    <tbody>
      {rows.map((job) => (
        <Row key={job.name} job={job} />
      ))}
    </tbody>
  </table>
);

function Row({ job }: { job: Job }) {
  const place = queue.value?.queuedJobs.indexOf(job.name) ?? -1;
  return (
    <tr>
      <th scope="row">
        <a href={jobPath(job.name)}>{job.displayName || job.name}</a>
        <span class="quiet">
          {numberOf(job.name)} · {kindText(job)}
        </span>
      </th>
      <td>
        <State state={job.state} waitsFor={job.waitsFor} />{' '}
        {(job.state === 'RUNNING' || job.state === 'CANCELLING') && <JobProgress job={job} />}
        {place >= 0 && <span class="quiet">position {place + 1}</span>}
        {job.state === 'FAILED' && <span class="why">{job.error?.message}</span>}
      </td>
      <td>{job.owner}</td>
      <td>
        <When time={job.createTime} />
      </td>
      <td class="actions">
        <Actions job={job} place={place} />
      </td>
    </tr>
  );
}

function Actions({ job, place }: { job: Job; place: number }) {
  if (!mayChange(job.owner)) return null;
  const id = `job ${numberOf(job.name)}`;
  const first = queue.value?.queuedJobs.find((name) => known.value.get(name)?.owner === job.owner);
  return (
    <>
      {place > 0 && first && first !== job.name && (
        <Button
          kind="plain"
          label={`Move ${id} to the front`}
          onPress={async () => {
            const moved = orNotify(await api.moveToFront(job.name, first));
            if (moved) remember(moved);
          }}
        >
          Move to front
        </Button>
      )}
      {!isFinished(job) && job.state !== 'CANCELLING' && (
        <Button
          kind="plain"
          label={`Cancel ${id}`}
          onPress={async () => {
            const cancelled = orNotify(await api.cancel(job.name));
            if (cancelled) remember(cancelled);
          }}
        >
          Cancel
        </Button>
      )}
      {canRetry(job) && (
        <Button
          kind="plain"
          label={`Retry ${id}`}
          onPress={async () => {
            const again = orNotify(await api.retry(job.name, newRequestId()));
            if (!again) return;
            remember(again);
            say(`${job.displayName} was submitted again`);
            go(`/${again.name}`);
          }}
        >
          Retry
        </Button>
      )}
    </>
  );
}
