import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import type { InspectSpec, ModelSummary, Role, Warning } from '../src/api/types';
import type { upload } from '../src/api/uploads';
import type { Engine } from '../src/engine/engine';
import { add } from '../src/model/dips';
import { done, refused } from '../src/model/result';
import {
  centre_mm,
  change,
  draft,
  jobOf,
  simulateOf,
  kEmpty,
  lacksCoordinates,
  renewed,
  rescale,
  shape,
  type Draft,
} from '../src/screens/new_print/draft';
import {
  arrangement,
  cancel,
  colourless,
  inputsOf,
  notes,
  problems,
  remove,
  startOver,
  take,
  waiting,
} from '../src/screens/new_print/intake';
import { stage } from '../src/screens/new_print/reading';
import { shapeOf } from './shapes';

/** What the daemon understands of the files. */
const kSummaries: Record<string, Partial<ModelSummary>> = {
  'bunny.stl': { format: 'STL' },
  'spot.obj': { hasTextureCoordinates: true, hasColour: true },
};
const kCompanions = ['spot.mtl', 'skin.png'];

const asked = vi.hoisted(() => ({
  read: vi.fn<Engine['read']>(),
  upload: vi.fn<typeof upload>(),
  may: vi.fn<(role: Role) => boolean>(),
}));
vi.mock('../src/engine/daemon', () => ({ daemon: { read: asked.read } }));
vi.mock('../src/api/uploads', () => ({ upload: asked.upload }));
vi.mock('../src/state/session', () => ({ may: asked.may }));

/** Reads as the worker does: without one of its files, the OBJ has no colours. */
async function answer({ mesh, extraFiles = [], shapeOnly }: InspectSpec) {
  const known = kSummaries[mesh.name!];
  if (!known) return refused('it is damaged', undefined, { reason: 'INPUT_REFUSED' });
  const there = new Set(extraFiles.map(({ name }) => name));
  const companions = kCompanions.map((name) => ({ name, isMissing: !there.has(name) }));
  const isComplete = mesh.name !== 'spot.obj' || companions.every(({ isMissing }) => !isMissing);
  if (!isComplete && !shapeOnly)
    return refused('no such file: skin.png', 'Put it there', { reason: 'INPUT_REFUSED' });
  const { source: _, ...model } = shapeOf({
    ...known,
    ...(mesh.name === 'spot.obj' ? { companions } : {}),
    ...(shapeOnly ? { hasColour: false } : {}),
  });
  return done(model);
}

const kPng = Uint8Array.of(0x89, 0x50, 0x4e, 0x47);
const file = (name: string, content: BlobPart) =>
  Object.assign(new Blob([content]), { name }) as unknown as File;
const picture = (name: string) => file(name, kPng);
const stl = () => file('bunny.stl', 'solid');
const obj = () => file('spot.obj', 'v 0 0 0');
const mtl = () => file('spot.mtl', 'newmtl m\nmap_Kd skin.png\n');
const names = (files: readonly { name: string }[]) => files.map(({ name }) => name);
const roles = () => inputsOf(draft.value.files).map(({ role, name }) => `${role} ${name}`);

beforeEach(() => {
  asked.read.mockReset().mockImplementation(answer);
  asked.upload
    .mockReset()
    .mockImplementation(async (blob) => done(`assets/${(blob as File).name}`));
  asked.may.mockReset().mockImplementation((role) => role === 'MAKER');
  startOver();
});
afterEach(() => vi.useRealTimers());

test('a picture waits for its model, and is then its texture', async () => {
  await take([picture('cat.png')]);
  expect(names(waiting.value)).toEqual(['cat.png']);
  await take([stl()]);
  expect(waiting.value).toEqual([]);
  expect(roles()).toEqual(['mesh bunny.stl', 'texture cat.png']);
  expect(lacksCoordinates.value).toBe(true);
});

test('several pictures wait; the materials of the model choose theirs', async () => {
  await take([picture('skin.png')]);
  await take([picture('other.png')]);
  expect(names(waiting.value)).toEqual(['other.png', 'skin.png']);
  await remove(waiting.value[0]!);
  expect(names(waiting.value)).toEqual(['skin.png']);
  await take([obj(), mtl()]);
  expect(roles()).toEqual(['mesh spot.obj', 'extra spot.mtl', 'extra skin.png']);
  expect(arrangement.value.missing).toEqual([]);
});

test('a missing texture is named until it is added', async () => {
  await take([obj(), mtl()]);
  expect(arrangement.value.missing).toEqual(['skin.png']);
  expect(colourless.value).toMatchObject([{ name: 'skin.png' }]);
  await take([picture('skin.png')]);
  expect(arrangement.value.missing).toEqual([]);
});

test('a missing material is named once', async () => {
  const missing: Warning = {
    code: 'MATERIAL_FILE_MISSING',
    message: 'the material file spot.mtl was not found',
    where: { dip: 0, file: { name: 'spot.obj', line: 0 } },
  };
  const other: Warning = { code: 'MESH_OPEN', message: 'the mesh has open edges' };
  asked.read.mockImplementation(async (spec) => {
    const read = await answer({ ...spec, shapeOnly: true });
    if (read.ok) read.value.summary.warnings = [missing, other];
    return read;
  });
  await take([obj()]);
  expect(names(colourless.value)).toEqual(['spot.mtl', 'skin.png']);
  expect(notes.value).toEqual([other]);
});

test('another texture replaces the missing one; without it, the file is missing again', async () => {
  await take([obj(), mtl()]);
  const own = picture('own.png');
  await take([own]);
  expect(arrangement.value).toMatchObject({ texture: own, missing: [] });
  await remove(own);
  expect(arrangement.value.missing).toHaveLength(1);
});

test('colours that cannot be read leave the shape, with the words of the refusal', async () => {
  asked.read.mockImplementation(async (spec) =>
    spec.shapeOnly
      ? answer({ ...spec, mesh: { name: 'bunny.stl', asset: '' } })
      : refused('texture skin.png is damaged', 'Save it again', { reason: 'INPUT_REFUSED' }),
  );
  await take([obj()]);
  expect(shape.value).toBeDefined();
  expect(problems.value).toEqual([]);
  expect(colourless.value).toEqual([
    { name: 'spot.obj', why: 'texture skin.png is damaged. Save it again' },
  ]);
  await take([picture('own.png')]);
  expect(colourless.value).toEqual([]);
});

test('a model is read again only if one of its files changes', async () => {
  await take([obj(), mtl(), picture('skin.png')]);
  expect(asked.read).toHaveBeenCalledTimes(1);
  const first = shape.value;
  await take([picture('cat.png')]);
  expect(arrangement.value.texture?.name).toBe('cat.png');
  expect(shape.value).toBe(first);
  expect(asked.read).toHaveBeenCalledTimes(1);
  await take([picture('skin.png')]);
  expect(asked.read).toHaveBeenCalledTimes(2);
  // Only the new picture is sent.
  expect(asked.upload).toHaveBeenCalledTimes(4);
  await take([file('more.mtl', 'newmtl n\n')]);
  expect(asked.read).toHaveBeenCalledTimes(3);
});

test('the daemon reads the uploaded files at the scale of the draft', async () => {
  await take([file('bunny.stl', 'solid')]);
  const mesh = { name: 'bunny.stl', asset: 'assets/bunny.stl' };
  expect(asked.read.mock.lastCall![0]).toEqual({ mesh, extraFiles: [], scale: 1 });
  change({ scale: 25.4 });
  await take([mtl()]);
  const extraFiles = [{ name: 'spot.mtl', asset: 'assets/spot.mtl' }];
  expect(asked.read.mock.lastCall![0]).toEqual({ mesh, extraFiles, scale: 25.4 });
  // The scale was that of the other object.
  await take([obj()]);
  expect(asked.read.mock.lastCall![0]).toMatchObject({ mesh: { name: 'spot.obj' }, scale: 1 });
});

test('the pictures of a model are closed once another one is shown', async () => {
  const close = vi.fn();
  asked.read.mockImplementation(async (spec) => {
    const read = await answer(spec);
    const picture = { close } as unknown as ImageBitmap;
    if (read.ok) read.value.mesh.parts[0]!.look = { colour: [1, 1, 1], picture };
    return read;
  });
  await take([stl()]);
  await take([picture('cat.png')]);
  expect(close).not.toHaveBeenCalled();
  await take([stl()]);
  expect(close).toHaveBeenCalledTimes(1);
});

test('pictures that come with a model but are not of its colours are named, and not used', async () => {
  await take([obj(), mtl(), picture('skin.png'), picture('normal.png')]);
  expect(arrangement.value.texture).toBeUndefined();
  expect(problems.value).toMatchObject([{ name: 'normal.png' }]);
  await take([picture('normal.png')]);
  expect(arrangement.value.texture?.name).toBe('normal.png');
});

/** Lets the daemon answer only when the returned function is called. */
function hold(): () => void {
  let release = () => {};
  const released = new Promise<void>((resolve) => (release = resolve));
  asked.read.mockImplementation(async (spec, signal) => {
    await released;
    return signal.aborted
      ? refused('cancelled', undefined, { reason: 'ABORTED_HERE' })
      : answer(spec);
  });
  return release;
}

test('files that are dropped while a model is read belong to it', async () => {
  const release = hold();
  const first = take([stl()]);
  await vi.waitFor(() => expect(stage.value?.text).toBe('Reading the model'));
  const second = take([picture('cat.png')]);
  release();
  await Promise.all([first, second]);
  expect(roles()).toEqual(['mesh bunny.stl', 'texture cat.png']);
  expect(draft.value.name).toBe('bunny');
  expect(stage.value).toBeUndefined();
});

test('a picture that waited stays while its model is read, if another picture is dropped', async () => {
  await take([picture('skin.png')]);
  const release = hold();
  const first = take([obj(), mtl()]);
  await vi.waitFor(() => expect(stage.value?.text).toBe('Reading the model'));
  const second = take([picture('normal.png')]);
  release();
  await Promise.all([first, second]);
  expect(roles()).toEqual(['mesh spot.obj', 'extra spot.mtl', 'extra skin.png']);
});

test('a new model is not lost when a file of the old one is removed meanwhile', async () => {
  await take([stl(), picture('cat.png')]);
  const release = hold();
  const taken = take([obj()]);
  await vi.waitFor(() => expect(stage.value).toBeDefined());
  const removed = remove(draft.value.files.find(({ name }) => name === 'cat.png')!);
  release();
  await Promise.all([taken, removed]);
  expect(roles()).toEqual(['mesh spot.obj']);
});

test('what was there stays when the reading of another model is cancelled', async () => {
  await take([stl()]);
  const before = shape.value;
  const release = hold();
  const taken = take([obj()]);
  await vi.waitFor(() => expect(stage.value).toBeDefined());
  cancel();
  release();
  await taken;
  expect(shape.value).toBe(before);
  expect(names(draft.value.files)).toEqual(['bunny.stl']);
  expect(problems.value).toEqual([]);
  expect(stage.value).toBeUndefined();
});

describe('a failure that ends by itself', () => {
  beforeEach(() => vi.useFakeTimers());

  test.each([
    [{ status: 0 }, 'does not answer'],
    [{ status: 503 }, 'does not answer'],
    [{ reason: 'PREVIEWS_FULL', status: 429 }, 'Others use all previews'],
    [{ reason: 'PREVIEW_SUPERSEDED', status: 409 }, 'Another page of yours'],
  ])('is waited for, and the page says so: %o', async (failure, words) => {
    asked.read.mockImplementationOnce(async () => refused('not now', undefined, failure));
    const taken = take([stl()]);
    await vi.waitFor(() => expect(stage.value?.text).toContain(words));
    expect(asked.read).toHaveBeenCalledTimes(1);
    await vi.runAllTimersAsync();
    await taken;
    expect(shape.value).toBeDefined();
    expect(problems.value).toEqual([]);
    expect(asked.read).toHaveBeenCalledTimes(2);
  });

  test('is not waited for any more once the reading is cancelled', async () => {
    asked.read.mockImplementation(async () => refused('not now', undefined, { status: 0 }));
    const taken = take([stl()]);
    await vi.waitFor(() => expect(stage.value?.text).toContain('does not answer'));
    cancel();
    await vi.advanceTimersByTimeAsync(60_000);
    await taken;
    expect(asked.read).toHaveBeenCalledTimes(1);
    expect(stage.value).toBeUndefined();
    expect(problems.value).toEqual([]);
  });
});

test('files that the daemon does not have any more are uploaded again, once', async () => {
  const missing = async () => refused('gone', undefined, { reason: 'ASSET_MISSING', status: 400 });
  asked.read.mockImplementationOnce(missing);
  await take([stl()]);
  expect(shape.value).toBeDefined();
  expect(asked.upload).toHaveBeenCalledTimes(2);
  startOver();
  asked.read.mockImplementation(missing);
  await take([stl()]);
  expect(problems.value).toEqual([{ name: 'bunny.stl', why: 'gone' }]);
  expect(asked.upload).toHaveBeenCalledTimes(4);
});

test('a model that comes with too many files is refused before anything is sent', async () => {
  const pictures = Array.from({ length: 257 }, (_, i) => picture(`${i}.png`));
  await take([obj(), ...pictures]);
  expect(asked.upload).not.toHaveBeenCalled();
  expect(problems.value[0]).toMatchObject({
    name: 'spot.obj',
    why: expect.stringMatching(/257 files.*at most 256.*Combine/),
  });
});

test('without the role Maker, a model is refused with the remedy', async () => {
  asked.may.mockReturnValue(false);
  await take([stl()]);
  expect(asked.upload).not.toHaveBeenCalled();
  expect(problems.value[0]!.why).toContain('Ask an admin for the role Maker');
});

test('the progress of uploads is that of all files', async () => {
  const seen: (number | undefined)[] = [];
  asked.upload.mockImplementation(async (blob, tell) => {
    tell(0.5, false);
    seen.push(stage.value?.share);
    return done(`assets/${(blob as File).name}`);
  });
  await take([file('bunny.stl', 'x'.repeat(300)), picture('cat.png')]);
  expect(seen.map((share) => share?.toFixed(3))).toEqual([
    (150 / 304).toFixed(3),
    (302 / 304).toFixed(3),
  ]);
});

test('an upload that fails names its file', async () => {
  asked.upload.mockResolvedValue(refused('the disk is full', 'Delete old jobs'));
  await take([stl()]);
  expect(asked.read).not.toHaveBeenCalled();
  expect(problems.value).toEqual([
    { name: 'bunny.stl', why: 'bunny.stl: the disk is full. Delete old jobs' },
  ]);
});

test('a damaged model does not replace the one that is there', async () => {
  await take([stl(), picture('cat.png')]);
  await take([file('bad.stl', 'solid')]);
  expect(problems.value).toEqual([{ name: 'bad.stl', why: 'it is damaged' }]);
  expect(roles()).toEqual(['mesh bunny.stl', 'texture cat.png']);
});

test('a picture that came with a damaged model waits for a better one', async () => {
  await take([file('bad.stl', 'solid'), picture('cat.png')]);
  expect(problems.value).toEqual([{ name: 'bad.stl', why: 'it is damaged' }]);
  expect(names(waiting.value)).toEqual(['cat.png']);
});

test('a new model replaces the old one and its texture, but not the film', async () => {
  await take([stl(), picture('cat.png'), file('film.toml', '[film]')]);
  await take([obj()]);
  expect(roles()).toEqual(['mesh spot.obj', 'profile film.toml']);
});

test('a job needs none of the dropped files that its model names', async () => {
  const from = { name: 'jobs/7', spec: { mesh: { name: 'spot.obj', asset: 'assets/1' } } };
  change({ from: from as unknown as NonNullable<Draft['from']> });
  const companions = kCompanions.map((name) => ({ name, isMissing: true }));
  shape.value = shapeOf({ companions, hasTextureCoordinates: true });
  const skin = picture('skin.png');
  await take([skin]);
  expect(arrangement.value).toMatchObject({ texture: skin, missing: [] });
  expect(asked.read).not.toHaveBeenCalled();
});

test('starting over forgets all files', async () => {
  await take([stl(), picture('cat.png')]);
  startOver();
  expect(shape.value).toBeUndefined();
  expect(arrangement.value.texture).toBeUndefined();
});

const jobWith = (more: Partial<Parameters<typeof simulateOf>[1]>) => {
  const inputs = { mesh: { name: 'x', asset: 'assets/1' }, extraFiles: [], ...more };
  return simulateOf(draft.value, inputs, centre_mm.value);
};

test('a job has the layer that was chosen, if it has a texture', async () => {
  const texture = { name: 'cat.png', asset: 'assets/2' };
  await take([stl(), picture('cat.png')]);
  expect(jobWith({ texture })).toMatchObject({ texture });
  expect(jobWith({ texture }).paint).toBeUndefined();
  change({ layer: { projection: 'box', size_mm: 60, turn_deg: 90 } });
  const chosen = { picture: texture, projection: 'box', sizeMm: 60, turnDeg: 90 };
  expect(jobWith({ texture }).paint).toEqual({ layers: [chosen] });
  expect(jobWith({ texture }).texture).toBeUndefined();
  expect(jobWith({}).paint).toBeUndefined();
  // The coordinates of another model place the texture.
  await take([obj()]);
  expect(jobWith({ texture })).toMatchObject({ texture });
});

test('two dips are a plan, one is a simulation', async () => {
  await take([stl()]);
  const inputs = {
    mesh: { name: 'x', asset: 'assets/1' },
    texture: { name: 'cat.png', asset: 'assets/2' },
    profile: { name: 'film.toml', asset: 'assets/3' },
    extraFiles: [],
  };
  const job = () => jobOf(draft.value, inputs, centre_mm.value);
  change({ depth_mm: 12, layer: { projection: 'box' } });
  expect(job().plan).toBeUndefined();
  const one = job().simulate!;
  change(add(draft.value));
  expect(job().simulate).toBeUndefined();
  const { object, immersions, film } = job().plan!;
  expect(immersions.length).toBe(2);
  expect(immersions[0]).toEqual({ pose: one.pose, depthMm: 12 });
  expect(immersions[1]!.pose!.rotationWxyz).not.toEqual(one.pose!.rotationWxyz);
  expect(object).toMatchObject({ mesh: inputs.mesh, scale: one.scale, paint: one.paint });
  expect(film).toMatchObject({ film: one.film, profile: inputs.profile });
  // Another object begins with one dip.
  await take([obj()]);
  expect(job().plan).toBeUndefined();
});

test('the paint of a job stays as it is if this page cannot change it', () => {
  const paint = { layers: [{ colour: '#ff0000' }, { colour: '#00ff00' }] };
  expect(jobWith({ paint }).paint).toEqual(paint);
});

test('a picture lands with its layer, if it becomes the texture', async () => {
  const layer = { projection: 'decal', size_mm: 3 } as const;
  await take([stl()]);
  await take([picture('cat.png')], layer);
  expect(draft.value.layer).toEqual(layer);
  await take([obj(), mtl()]);
  expect(draft.value.layer).toEqual({});
  // A material names this picture.
  await take([picture('skin.png')], layer);
  expect(draft.value.layer).toEqual({});
});

test('a change of the unit keeps the picture at its place on the object', () => {
  change({
    scale: 1,
    layer: { projection: 'decal', position_mm: [1, 2, 3], size_mm: 4, turn_deg: 30 },
  });
  rescale(10);
  expect(draft.value).toMatchObject({
    scale: 10,
    layer: { projection: 'decal', position_mm: [10, 20, 30], size_mm: 40, turn_deg: 30 },
  });
});

test('a draft of an earlier version keeps its projection', () => {
  const { layer: _, ...rest } = kEmpty;
  const old = { ...rest, projection: { kind: 'box', size_mm: 60 } } as unknown as Draft;
  expect(renewed(old).layer).toEqual({ projection: 'box', size_mm: 60 });
  expect(renewed(kEmpty).layer).toEqual({});
});
