/** Creates the jobs of a plan's steps. */
import { effect } from '@preact/signals';
import { jobs as api, newRequestId } from '../../api/services';
import type { Job, JobInput, PlannedDip } from '../../api/types';
import { isFinished, known, remember } from '../../state/jobs';
import { orNotify } from '../../state/notices';
import { read } from './progress';
import { calibration, capture, layout, simulation } from './steps';

async function create(job: JobInput): Promise<Job | undefined> {
  const made = orNotify(await api.create(job, newRequestId()));
  if (made) remember(made);
  return made;
}

/** Waits until the job is finished, as far as the page's events tell. */
const ended = (name: string): Promise<Job> =>
  new Promise((resolve) => {
    const stop = effect(() => {
      const job = known.value.get(name);
      if (!job || !isFinished(job)) return;
      resolve(job);
      // Only after this run, because it may be the first one.
      queueMicrotask(() => stop());
    });
  });

/** Creates the job and returns it once it is finished; undefined if it was refused. */
async function run(job: JobInput): Promise<Job | undefined> {
  const made = await create(job);
  return made && ended(made.name);
}

/** Records frames of the hanging object, then measures its pose. */
async function calibrate(plan: Job, dip: PlannedDip): Promise<void> {
  const frames = await run(capture(plan, dip));
  if (frames?.state === 'SUCCEEDED') await run(calibration(plan, dip, frames.name));
}

export const compute = async (plan: Job, dip: PlannedDip): Promise<void> => {
  await create(simulation(plan, dip));
  await read(plan.name);
};

/** Does the next step of a dip, if it creates jobs. */
export async function take(plan: Job, dip: PlannedDip): Promise<void> {
  if (dip.step === 'CALIBRATE') await calibrate(plan, dip);
  if (dip.step === 'SIMULATE') await create(simulation(plan, dip));
  if (dip.step === 'LAY_OUT') await create(layout(plan, dip));
  await read(plan.name);
}
