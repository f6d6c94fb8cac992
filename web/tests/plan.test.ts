import { describe, expect, test } from 'vitest';
import type { Job, PlannedDip, PlanProgress, Rig } from '../src/api/types';
import {
  actionText,
  calibration,
  filesOf,
  layout,
  needsHoming,
  nextOf,
  pageOf,
  rigPath,
  roleFor,
  simulation,
  type Step,
} from '../src/screens/plan/steps';

const pose = { rotationWxyz: [0, 1, 0, 0], translationMm: [1, 2, 3], fromNominalPose: [] };
const mesh = { name: 'mug.obj', asset: 'assets/1' };
const plan = {
  name: 'jobs/7',
  displayName: 'mug',
  labels: { paper: 'A3', colours: 'COLOURS_CMYK' },
  plan: {
    object: { mesh, extraFiles: [{ name: 'mug.mtl', asset: 'assets/2' }], scale: 10 },
    immersions: [{}, { pose }],
    film: { film: 'A3' },
  },
} as unknown as Job;

const dip = (step: Step, more: Partial<PlannedDip> = {}): PlannedDip =>
  ({ immersion: 2, step, simulateJob: '', calibration: '', job: '', ...more }) as PlannedDip;

describe('the jobs of a step', () => {
  test('calibrate near the planned pose, with the object and the film of the plan', () => {
    expect(calibration(plan, dip('CALIBRATE'), 'jobs/8').calibrate).toEqual({
      captureJob: 'jobs/8',
      mesh,
      extraFiles: [{ name: 'mug.mtl', asset: 'assets/2' }],
      scale: 10,
      film: 'A3',
      pose,
    });
    const { calibrate } = calibration(plan, dip('CALIBRATE', { immersion: 1 }), 'jobs/8');
    expect(calibrate).not.toHaveProperty('pose');
  });

  test('compute for the measured pose, or for the planned one', () => {
    const planned = { planJob: 'jobs/7', immersion: 2 };
    expect(simulation(plan, dip('SIMULATE')).simulate).toEqual(planned);
    expect(simulation(plan, dip('SIMULATE', { calibration: 'calibrations/4' }))).toMatchObject({
      displayName: 'mug, dip 2 of 2',
      simulate: { ...planned, calibration: 'calibrations/4' },
    });
  });

  test('lay out with the paper and the colours of the plan', () => {
    expect(layout(plan, dip('LAY_OUT', { simulateJob: 'jobs/9' })).printImage).toEqual({
      simulateJob: 'jobs/9',
      jobName: 'mug, dip 2 of 2',
      paper: 'A3',
      colours: 'COLOURS_CMYK',
    });
  });
});

test('other steps are done on their pages', () => {
  expect(pageOf(dip('DIP', { simulateJob: 'jobs/9' }))).toBe('#/rig?job=9');
  expect(rigPath(plan)).toBe('#/rig?plan=7');
  expect(pageOf(dip('CONFIRM', { job: 'jobs/11' }))).toBe('#/rig');
  expect(pageOf(dip('WAIT', { job: 'jobs/12' }))).toBe('#/jobs/12');
  expect(actionText(dip('WAIT', { job: 'jobs/12' }))).toContain('12');
  for (const step of ['CALIBRATE', 'SIMULATE', 'LAY_OUT'] as const)
    expect(pageOf(dip(step))).toBeUndefined();
});

test('a step needs the role that the daemon asks for', () => {
  const roles = (['CALIBRATE', 'SIMULATE', 'LAY_OUT', 'DIP', 'WAIT', 'CONFIRM'] as const).map(
    (step) => roleFor(dip(step)),
  );
  expect(roles).toEqual(['OPERATOR', 'MAKER', 'MAKER', 'OPERATOR', 'VIEWER', 'OPERATOR']);
});

test('the rig is homed before a dip is calibrated, if it has an axis', () => {
  const rig = (homed: boolean, axis?: object) => ({ homed, axis }) as Rig;
  expect(needsHoming(dip('CALIBRATE'), rig(false, {}))).toBe(true);
  expect(needsHoming(dip('CALIBRATE'), rig(true, {}))).toBe(false);
  expect(needsHoming(dip('CALIBRATE'), rig(false))).toBe(false);
  expect(needsHoming(dip('CALIBRATE'), undefined)).toBe(false);
  expect(needsHoming(dip('LAY_OUT'), rig(false, {}))).toBe(false);
});

test('the next dip is the one that the daemon names; none if all are done', () => {
  const dips = [dip('DONE', { immersion: 1 }), dip('DIP')];
  const progress = { planJob: 'jobs/7', dips } as PlanProgress;
  expect(nextOf({ ...progress, nextImmersion: 2 })).toBe(dips[1]);
  expect(nextOf({ ...progress, nextImmersion: 0 })).toBeUndefined();
});

test('the files of a dip are the plan’s until it has a simulation of its own', () => {
  const planned = filesOf('jobs/7', dip('SIMULATE'));
  expect([planned.job, planned.name('mask')]).toEqual(['jobs/7', 'mask-2.png']);
  const own = filesOf('jobs/7', dip('DIP', { simulateJob: 'jobs/9' }));
  expect([own.job, own.name('mask')]).toEqual(['jobs/9', 'mask.png']);
});
