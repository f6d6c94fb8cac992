/** Texts that describe jobs, the same on every screen. */
import type { Job, JobState, Queue } from '../api/types';
import { formatSeconds, formatTime } from '../model/units';
import { now, secondsUntil } from './clock';
import { Progress } from './controls';

const kStates: Record<JobState, string> = {
  STATE_UNSPECIFIED: 'unknown',
  QUEUED: 'queued',
  WAITING_FOR_OPERATOR: 'waiting for operator',
  RUNNING: 'running',
  CANCELLING: 'cancelling',
  SUCCEEDED: 'done',
  FAILED: 'failed',
  CANCELLED: 'cancelled',
  INTERRUPTED: 'interrupted',
};

const kKinds = {
  simulate: 'film image',
  plan: 'plan of several dips',
  predict: 'prediction',
  fit: 'film profile',
  validate: 'validation',
  dip: 'dip',
  printImage: 'pages to print',
  template: 'placement template',
  print: 'print',
  capture: 'camera frames',
  calibrateCamera: 'camera calibration',
  calibrate: 'calibration',
} as const;

export type Kind = keyof typeof kKinds;

/** The kind of a job, given by the spec that is set. */
export const kindOf = (job: Job): Kind | undefined =>
  (Object.keys(kKinds) as Kind[]).find((kind) => job[kind as keyof Job] != null);

export const kindText = (job: Job): string => {
  const kind = kindOf(job);
  return kind ? kKinds[kind] : 'job';
};

export const numberOf = (name: string): string => name.split('/')[1] ?? name;

/** Which of the dips of an object: "Dip 2 of 3". */
export const dipText = (immersion: number, immersions: number): string =>
  `Dip ${immersion} of ${immersions}`;

export const State = ({ state, waitsFor }: { state: JobState; waitsFor?: string }) => (
  <span class={`state ${state.toLowerCase()}`}>
    {waitsFor ? 'waiting' : (kStates[state] ?? state.toLowerCase())}
  </span>
);

/** Why no queued job starts; undefined if jobs start in their turn. */
export function holdReason(queue: Queue | undefined): string | undefined {
  if (queue?.paused) return `the queue is paused${queue.pauseReason && `: ${queue.pauseReason}`}`;
  return queue?.blockedReason || undefined;
}

/** Progress and remaining time of a job. */
export function JobProgress({ job, queue }: { job: Job; queue?: Queue }) {
  const reason = job.state === 'QUEUED' ? (holdReason(queue) ?? 'in the queue') : job.waitsFor;
  if (reason) return <span class="quiet">waiting: {reason}</span>;
  const left = secondsUntil(job.etaTime);
  return (
    <span class="how-far">
      <Progress share={job.progressFraction} label={`Progress of job ${numberOf(job.name)}`} />
      <span>
        {Math.round(100 * job.progressFraction)} %
        {left !== undefined && left > 0 && `, ${formatSeconds(left)} left`}
        {job.phase && <span class="quiet"> {job.phase.toLowerCase().replaceAll('_', ' ')}</span>}
      </span>
    </span>
  );
}

export const When = ({ time }: { time: string | undefined }) => {
  if (!time) return null;
  const date = new Date(time);
  return (
    <time dateTime={time} title={date.toLocaleString()}>
      {formatTime(date, now.peek())}
    </time>
  );
};
