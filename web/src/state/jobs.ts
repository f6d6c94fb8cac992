/** Jobs known to the page, kept up to date by events. */
import { effect, signal } from '@preact/signals';
import { jobs as api, queue as queueApi } from '../api/services';
import type { Job, JobEvent, Queue } from '../api/types';
import { beginnings, on } from '../events';

export const known = signal<ReadonlyMap<string, Job>>(new Map());
export const queue = signal<Queue | undefined>(undefined);
/** Number of events for unknown jobs. Lists fetch their jobs again when it changes. */
export const arrivals = signal(0);

// A response must not overwrite a newer event that arrived before it.
const isOlder = (job: Job, than: Job | undefined): boolean =>
  than !== undefined && Date.parse(job.updateTime ?? '') < Date.parse(than.updateTime ?? '');

export function remember(...jobs: Job[]): void {
  const all = new Map(known.value);
  for (const job of jobs) if (!isOlder(job, all.get(job.name))) all.set(job.name, job);
  known.value = all;
}

export function forget(name: string): void {
  const all = new Map(known.value);
  all.delete(name);
  known.value = all;
}

const asked = new Set<string>();

/** Fetches a job. Concurrent calls for the same job share one request. */
export async function refresh(name: string): Promise<void> {
  if (asked.has(name)) return;
  asked.add(name);
  const answer = await api.get(name);
  asked.delete(name);
  if (answer.ok) remember(answer.value);
}

on('job', (data) => {
  const { job, event } = data as { job?: Job; event?: JobEvent };
  if (job?.name) {
    if (!known.value.has(job.name)) arrivals.value += 1;
    remember(job);
    return;
  }
  if (event?.job) take(event);
});

// An event has fewer fields than the job. Its fields are merged, and the job is fetched if its state changed.
function take(event: JobEvent): void {
  const job = known.value.get(event.job ?? '');
  if (!job) {
    arrivals.value += 1;
    return;
  }
  remember({
    ...job,
    state: event.state ?? job.state,
    progressFraction: event.progressFraction ?? job.progressFraction,
    phase: event.phase ?? job.phase,
    waitsFor: event.waitsFor ?? job.waitsFor,
    ...(event.etaTime ? { etaTime: event.etaTime } : {}),
  });
  if (event.kind !== 'PROGRESS') void refresh(job.name);
}

on('queue', (data) => {
  queue.value = data as Queue;
});

effect(() => {
  if (beginnings.value === 0) return;
  void queueApi.get().then((answer) => {
    if (answer.ok) queue.value = answer.value;
  });
});

export const kFinished: readonly Job['state'][] = [
  'SUCCEEDED',
  'FAILED',
  'CANCELLED',
  'INTERRUPTED',
];
export const kOpen: readonly Job['state'][] = [
  'QUEUED',
  'WAITING_FOR_OPERATOR',
  'RUNNING',
  'CANCELLING',
];
/** INTERRUPTED is final for dips, prints and captures. The daemon queues other interrupted jobs again. */
export const isFinished = (job: Job): boolean => kFinished.includes(job.state);

/** True if the job can be repeated unchanged. Dips, prints and captures cannot. */
export const canRetry = (job: Job): boolean =>
  isFinished(job) && job.state !== 'SUCCEEDED' && !job.dip && !job.print && !job.capture;
