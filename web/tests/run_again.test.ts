import { beforeEach, expect, test, vi } from 'vitest';
import { jobs } from '../src/api/services';
import type { Job } from '../src/api/types';
import { move } from '../src/model/dips';
import {
  centre_mm,
  change,
  clear,
  draft,
  jobOf,
  shape,
  startFrom,
  takeDipsOfJob,
  type Inputs,
} from '../src/screens/new_print/draft';
import { markOf } from './marks';
import { shapeOf } from './shapes';

const kHalf = Math.SQRT1_2;
const mesh = { name: 'mug.obj', asset: 'assets/1' };
const texture = { name: 'mug.png', asset: 'assets/2' };
const immersions = [
  { pose: { rotationWxyz: [kHalf, kHalf, 0, 0], translationMm: [-20, 60, -40] }, depthMm: 12 },
  { pose: { rotationWxyz: [kHalf, -kHalf, 0, 0], translationMm: [-20, -60, 40] } },
];
const plan = {
  object: { mesh, texture, extraFiles: [], scale: 10 },
  immersions,
  film: { film: 'A3', model: 'MODEL_STOKES', dipSpeedMmPerS: 8 },
  dpi: 600,
  blendMm: 2,
};
const labels = { paper: 'A3', colours: 'COLOURS_CMYK' };

function read(job: Partial<Job>): void {
  vi.spyOn(jobs, 'get').mockResolvedValue({
    ok: true,
    value: { name: 'jobs/7', displayName: 'mug', labels, ...job } as Job,
  });
}

/** The middle of the object is at 20, 40, 60 mm. */
async function open(job: Partial<Job>): Promise<void> {
  read(job);
  expect((await startFrom('jobs/7')).ok).toBe(true);
  shape.value = shapeOf({}, { min: [1, 3, 5], max: [3, 5, 7] });
  takeDipsOfJob();
}

const inputs: Inputs = { mesh, texture, extraFiles: [] };
const made = () => jobOf(draft.value, inputs, centre_mm.value);

const message = 'the film image would have too many pixels. Use at most 900 dpi for this film';

beforeEach(clear);

/** Numbers to 9 digits, because poses are converted back and forth. */
const rounded = (value: unknown) =>
  JSON.parse(JSON.stringify(value), (_, part) =>
    typeof part === 'number' ? Number(part.toFixed(9)) + 0 : part,
  );

test('a plan that is run again without changes is the same plan', async () => {
  await open({ plan } as unknown as Job);
  expect(rounded(made())).toEqual(rounded({ displayName: 'mug', labels, plan }));
});

test('the order of its dips can be changed', async () => {
  await open({ plan } as unknown as Job);
  change(move(draft.value, 0, 1));
  expect(rounded(made().plan?.immersions)).toEqual(rounded([...immersions].reverse()));
});

test('a changed draft keeps its changes when the object of the job is read again', async () => {
  await open({ plan } as unknown as Job);
  change(move(draft.value, 0, 1));
  const before = draft.value;
  takeDipsOfJob();
  expect(draft.value).toEqual(before);
});

test('a simulation is run again with its pose and its depth', async () => {
  const [dip] = immersions;
  await open({ simulate: { mesh, texture, extraFiles: [], scale: 10, ...dip } } as unknown as Job);
  expect(rounded(made().simulate)).toMatchObject(rounded(dip));
  expect(made().plan).toBeUndefined();
});

test('the field for which a job failed is marked until another draft begins', async () => {
  const error = { code: 'OUT_OF_RANGE', reason: 'INPUT_REFUSED', field: 'simulate.dpi', message };
  await open({ simulate: { mesh, extraFiles: [], dpi: 2400 }, error } as unknown as Job);
  expect(draft.value.dpi).toBe(2400);
  expect(markOf({ name: 'dpi' })).toBe(`${message}.`);
  clear();
  expect(markOf({ name: 'dpi' })).toBeUndefined();
});

test('other jobs are refused with a remedy', async () => {
  read({ capture: {} } as unknown as Job);
  const answer = await startFrom('jobs/7');
  expect(!answer.ok && answer.failure.what).toContain('not a simulation or a plan');
  expect(!answer.ok && answer.failure.remedy).toContain('Run again with changes');
});
