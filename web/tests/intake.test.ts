import { beforeEach, expect, test, vi } from 'vitest';
import { add } from '../src/model/dips';
import type { Mesh } from '../src/model/mesh';
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
  inputsOf,
  problems,
  remove,
  startOver,
  take,
  waiting,
} from '../src/screens/new_print/intake';

const kTriangle = (more: Partial<Mesh> = {}): Mesh => ({
  positions: Float32Array.from([0, 0, 0, 9, 0, 0, 0, 9, 0]),
  indices: Uint32Array.from([0, 1, 2]),
  parts: [{ material: '', first: 0, count: 3 }],
  libraries: [],
  ...more,
});
const kMeshes: Record<string, Mesh> = {
  'bunny.stl': kTriangle(),
  'spot.obj': kTriangle({
    uvs: new Float32Array(6),
    parts: [{ material: 'm', first: 0, count: 3 }],
    libraries: ['spot.mtl'],
  }),
};
vi.mock('../src/worker/reader', () => ({
  readMesh: async ({ name }: File) => {
    const mesh = kMeshes[name];
    return mesh
      ? done({ mesh, box: { min: [0, 0, 0], max: [9, 9, 0] } })
      : refused('it is damaged');
  },
}));

const kPng = Uint8Array.of(0x89, 0x50, 0x4e, 0x47);
const file = (name: string, content: BlobPart) =>
  Object.assign(new Blob([content]), { name }) as unknown as File;
const picture = (name: string) => file(name, kPng);
const stl = () => file('bunny.stl', 'solid');
const obj = () => file('spot.obj', 'v 0 0 0');
const mtl = () => file('spot.mtl', 'newmtl m\nmap_Kd skin.png\n');
const names = (files: readonly { name: string }[]) => files.map(({ name }) => name);
const roles = () => inputsOf(draft.value.files).map(({ role, name }) => `${role} ${name}`);

beforeEach(startOver);

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
  expect(arrangement.value.missing).toEqual([{ name: 'skin.png', by: 'spot.mtl' }]);
  await take([picture('skin.png')]);
  expect(arrangement.value.missing).toEqual([]);
});

test('another texture replaces the missing one; without it, the file is missing again', async () => {
  await take([obj(), mtl()]);
  const own = picture('own.png');
  await take([own]);
  expect(arrangement.value).toMatchObject({ texture: own, missing: [] });
  await remove(own);
  expect(arrangement.value.missing).toHaveLength(1);
});

test('a picture that came with a damaged model waits for a better one', async () => {
  await take([file('bad.stl', 'solid'), picture('cat.png')]);
  expect(problems.value).toEqual([{ name: 'bad.stl', why: 'it is damaged' }]);
  expect(names(waiting.value)).toEqual(['cat.png']);
});

test('a new model replaces the old one and its texture', async () => {
  await take([stl(), picture('cat.png')]);
  await take([obj()]);
  expect(roles()).toEqual(['mesh spot.obj']);
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
