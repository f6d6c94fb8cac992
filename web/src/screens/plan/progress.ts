/** The progress of the plan on the page, read again when a job changes. */
import { signal } from '@preact/signals';
import { jobs as api } from '../../api/services';
import type { JobEvent, PlanProgress } from '../../api/types';
import { on } from '../../events';
import { orNotify } from '../../state/notices';

export const progress = signal<PlanProgress | undefined>(undefined);

const kPause_ms = 150;

export async function read(plan: string): Promise<void> {
  const answer = orNotify(await api.planProgress(plan));
  if (answer) progress.value = answer;
}

/** Keeps the progress of a plan up to date until the returned function is called. */
export function follow(plan: string): () => void {
  let timer: number | undefined;
  void read(plan);
  const end = on('job', (data) => {
    if ((data as { event?: JobEvent }).event?.kind === 'PROGRESS') return;
    window.clearTimeout(timer);
    timer = window.setTimeout(() => void read(plan), kPause_ms);
  });
  return () => {
    window.clearTimeout(timer);
    end();
  };
}
