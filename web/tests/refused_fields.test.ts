/** Fields that the daemon refuses: their labels, and their marks in a form. */
import { h, render } from 'preact';
import { useState } from 'preact/hooks';
import { beforeEach, expect, test, vi } from 'vitest';
import { call } from '../src/api/call';
import type { Job, WhoAmI } from '../src/api/types';
import { inputOf, withLabel } from '../src/model/fields';
import { JobScreen } from '../src/screens/job';
import { remember } from '../src/state/jobs';
import { who } from '../src/state/session';
import { Choice, NumberField } from '../src/ui/controls';
import { markRefused } from '../src/ui/field_errors';
import { markOf } from './marks';
import { TinyNode } from './tiny_dom';

vi.mock('../src/worker/reader', () => ({}));

const rendered = async () => {
  for (let i = 0; i < 20; i += 1) await Promise.resolve();
};

/** As daemon/rest/status.cpp sends it. */
const invalid = (...fields: { field: string; description: string }[]) => ({
  error: {
    code: 400,
    status: 'INVALID_ARGUMENT',
    message: fields.map(({ field, description }) => `${field}: ${description}`).join('; '),
    details: [
      {
        '@type': 'type.googleapis.com/google.rpc.ErrorInfo',
        reason: 'SPEC_INVALID',
        domain: 'hydroprint',
        metadata: { field: fields[0]!.field },
      },
      { '@type': 'type.googleapis.com/google.rpc.BadRequest', fieldViolations: fields },
    ],
  },
});

async function refused(answer: unknown) {
  vi.spyOn(globalThis, 'fetch').mockResolvedValue(Response.json(answer, { status: 400 }));
  const result = await call('POST', 'jobs');
  if (result.ok) throw new Error('not refused');
  return result.failure;
}

const kDpi = { field: 'simulate.dpi', description: 'must be from 20 to 2400 dots per inch' };
const kDepth = { field: 'plan.immersions[1].depth_mm', description: 'must be at most 10000 mm' };

beforeEach(() => {
  markRefused('job');
  markRefused('preview');
});

test('a path in a job is worded as the label of its input', () => {
  const labelOf = (path: string) => withLabel(path, '').slice(0, -2);
  expect(labelOf('simulate.dpi')).toBe('Resolution');
  expect(labelOf('plan.film.dip_speed_mm_per_s')).toBe(inputOf('dipSpeedMmPerS').label);
  expect(labelOf('plan.film.film')).toBe('Film');
  expect(labelOf('plan.object.paint.layers[1].size_mm')).toBe('Width of the picture');
  expect(labelOf('plan.immersions[1].depth_mm')).toBe('Depth of dip 2');
  expect(labelOf('plan.immersions[1].depthMm')).toBe(inputOf('depthMm', 1).label);
  expect(labelOf('simulate.pose.translation_mm')).toBe('Pose');
  expect(labelOf('print_image.paper')).toBe('Paper');
});

test('a path without an input stays as it is, and a problem without a field too', () => {
  for (const path of ['simulate.threads', 'plan.constructor', 'dip.soak_s', 'display_name'])
    expect(withLabel(path, 'is wrong')).toBe(`${path}: is wrong`);
  expect(withLabel('', 'is wrong')).toBe('is wrong');
});

test('a refused request is described with labels instead of paths', async () => {
  const failure = await refused(
    invalid({ field: 'simulate.mesh', description: 'is missing' }, kDpi),
  );
  expect(failure.what).toBe('Model: is missing; Resolution: must be from 20 to 2400 dots per inch');
  expect(failure.reason).toBe('SPEC_INVALID');
  expect(failure.violations?.[1]).toEqual(kDpi);
});

test('a failed job shows its error with the label of the field, and the way back to the form', () => {
  const error = {
    code: 'OUT_OF_RANGE',
    reason: 'INPUT_REFUSED',
    message: 'the film image would have too many pixels. Use at most 900 dpi for this film',
    field: 'simulate.dpi',
    exitStatus: 3,
  };
  vi.spyOn(globalThis, 'fetch').mockResolvedValue(Response.json({}));
  who.value = { user: 'mia', role: 'MAKER' } as WhoAmI;
  remember({ name: 'jobs/7', state: 'FAILED', simulate: {}, error } as unknown as Job);
  const page = new TinyNode(1, 'main');
  render(h(JobScreen, { name: 'jobs/7' }), page as unknown as Element);
  expect(page.text).toContain(`Resolution: ${error.message}`);
  expect(page.text).toContain('Run again with changes');
});

test('a field of one dip is marked at that dip only', () => {
  markRefused('job', [kDepth]);
  expect(markOf({ name: 'depthMm', dip: 1 })).toBe('must be at most 10000 mm.');
  expect(markOf({ name: 'depthMm', dip: 0 })).toBeUndefined();
});

test('a preview replaces the marks of the preview before, not those of the job', () => {
  markRefused('job', [kDpi]);
  markRefused('preview', [{ field: 'simulate.pose', description: 'misses the film' }]);
  expect(markOf({ name: 'pose', dip: 2 })).toBe('misses the film.');
  markRefused('preview');
  expect(markOf({ name: 'pose', dip: 2 })).toBeUndefined();
  expect(markOf({ name: 'dpi' })).toBeDefined();
});

/** A form with a depth, below details, and a resolution. */
function Form() {
  const [depth, setDepth] = useState(5);
  const [dpi, setDpi] = useState('300');
  return h('form', {}, [
    h('details', {}, [
      h(NumberField, {
        ...inputOf('depthMm', 1),
        unit: 'mm',
        min: 1,
        max: 99999,
        value: depth,
        onValue: setDepth,
      }),
    ]),
    h(Choice<string>, {
      ...inputOf('dpi'),
      value: dpi,
      onValue: setDpi,
      choices: ['300', '600'].map((value) => ({ value, label: value })),
    }),
  ]);
}

test('refused inputs are marked and described until they are changed', async () => {
  const page = new TinyNode(1, 'main');
  render(h(Form, {}), page as unknown as Element);
  const [input, select] = [page.find('input')!, page.find('select')!];
  const marks = () => [input, select].map((node) => node.attribute('aria-invalid'));
  expect(marks()).toEqual(['false', 'false']);

  markRefused('job', (await refused(invalid(kDepth, kDpi))).violations);
  await rendered();
  expect(marks()).toEqual(['true', 'true']);
  expect(page.find('details')!.attribute('open')).toBe('');
  expect(input.attribute('aria-describedby')).toContain('-error');
  expect(page.text).toContain(kDepth.description);

  input.value = '50';
  input.fire('input');
  await rendered();
  expect(marks()).toEqual(['false', 'true']);
  expect(page.text).not.toContain(kDepth.description);

  select.value = '600';
  select.fire('change');
  await rendered();
  expect(marks()).toEqual(['false', 'false']);
});
