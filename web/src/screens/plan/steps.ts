/** The steps of a plan's dips, as jobs and links. Without DOM. */
import type { Job, JobInput, PlannedDip, PlanProgress, PlanSpec, Rig, Role } from '../../api/types';
import { jobPath } from '../../route';
import { numberOf, dipText } from '../../ui/job_text';
import { pagesOf } from '../job/pages';

export type Step = PlannedDip['step'];

/** The dip to go on with; undefined if all are done. */
export const nextOf = ({ dips, nextImmersion }: PlanProgress): PlannedDip | undefined =>
  dips.find(({ immersion }) => immersion === nextImmersion);

const kStates: Record<Step, string> = {
  STEP_UNSPECIFIED: 'unknown',
  CALIBRATE: 'to be hung and calibrated',
  SIMULATE: 'to be computed',
  LAY_OUT: 'computed',
  DIP: 'ready to be printed and dipped',
  WAIT: 'in progress',
  CONFIRM: 'being dipped',
  DONE: 'done',
};

export const stateText = ({ step }: PlannedDip): string => kStates[step];

/** The class of the state's mark, one of those of job states. */
export const stateClass = ({ step }: PlannedDip): string =>
  ({ DONE: 'succeeded', WAIT: 'running', CONFIRM: 'waiting_for_operator' })[step as string] ?? '';

const kActions: Partial<Record<Step, string>> = {
  CALIBRATE: 'The object hangs as pictured: calibrate',
  SIMULATE: 'Compute the film image',
  LAY_OUT: 'Create PDF',
  DIP: 'Dip',
  CONFIRM: 'Continue on the Rig page',
};

export const actionText = (dip: PlannedDip): string =>
  kActions[dip.step] ?? `Follow job ${numberOf(dip.job)}`;

/** True if the rig must be homed before the dip is calibrated, because homing makes calibrations invalid. */
export const needsHoming = ({ step }: PlannedDip, rig: Rig | undefined): boolean =>
  step === 'CALIBRATE' && rig?.axis !== undefined && !rig.homed;

/** The role that the step needs. */
export const roleFor = ({ step }: PlannedDip): Role => {
  if (step === 'CALIBRATE' || step === 'DIP' || step === 'CONFIRM') return 'OPERATOR';
  return step === 'SIMULATE' || step === 'LAY_OUT' ? 'MAKER' : 'VIEWER';
};

/** The page on which the step is done; undefined if it creates jobs. */
export function pageOf(dip: PlannedDip): string | undefined {
  if (dip.step === 'DIP') return dipPath(dip);
  if (dip.step === 'CONFIRM') return '#/rig';
  return dip.step === 'WAIT' ? jobPath(dip.job) : undefined;
}

/** The page on which the rig is prepared for a dip of the plan. */
export const rigPath = ({ name }: Job): string => `#/rig?plan=${numberOf(name)}`;

/** The page that begins the dip with the film image of its simulation. */
export const dipPath = ({ simulateJob }: PlannedDip): string =>
  `#/rig?job=${numberOf(simulateJob)}`;

const dipsOf = ({ plan }: Job): number => plan?.immersions.length ?? 0;

const titleOf = (plan: Job, { immersion }: PlannedDip): string =>
  `${plan.displayName || plan.name}, ${dipText(immersion, dipsOf(plan)).toLowerCase()}`;

/** Names that belong to every job of a dip. */
const heading = (plan: Job, dip: PlannedDip) => ({
  displayName: titleOf(plan, dip),
  labels: plan.labels,
});

/** Computes the film image of the dip: for the measured pose, or for the planned one. */
export const simulation = (plan: Job, dip: PlannedDip): JobInput => ({
  ...heading(plan, dip),
  simulate: {
    planJob: plan.name,
    immersion: dip.immersion,
    ...(dip.calibration ? { calibration: dip.calibration } : {}),
  },
});

/** Lays out the film image of the dip's simulation. */
export function layout(plan: Job, dip: PlannedDip): JobInput {
  const { displayName, labels } = heading(plan, dip);
  return {
    displayName,
    labels,
    printImage: pagesOf({ name: dip.simulateJob, displayName, labels }),
  };
}

export const capture = (plan: Job, dip: PlannedDip): JobInput => ({
  ...heading(plan, dip),
  capture: {},
});

/** Measures the object's pose from the frames of a capture, near the planned pose. */
export function calibration(plan: Job, dip: PlannedDip, captureJob: string): JobInput {
  const { object, film, immersions } = plan.plan as PlanSpec;
  const pose = immersions[dip.immersion - 1]?.pose;
  return {
    ...heading(plan, dip),
    calibrate: {
      captureJob,
      mesh: object?.mesh,
      extraFiles: object?.extraFiles,
      ...(object?.scale !== undefined ? { scale: object.scale } : {}),
      ...(film?.film !== undefined ? { film: film.film } : {}),
      ...(pose ? { pose } : {}),
    } as NonNullable<JobInput['calibrate']>,
  };
}

/** The files of a dip: those of its own simulation, otherwise those of the plan. */
export function filesOf(
  plan: string,
  dip: PlannedDip,
): { job: string; name: (kind: string) => string } {
  return dip.simulateJob
    ? { job: dip.simulateJob, name: (kind) => `${kind}.png` }
    : { job: plan, name: (kind) => `${kind}-${dip.immersion}.png` };
}
