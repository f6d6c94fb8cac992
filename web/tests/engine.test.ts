import { afterEach, expect, test, vi } from 'vitest';
import { previewOf } from '../src/engine/daemon';
import { modelOf } from '../src/engine/model';

const joined = (parts: Uint8Array[]): ArrayBuffer => {
  const out = new Uint8Array(parts.reduce((sum, { length }) => sum + length, 0));
  parts.reduce((at, part) => (out.set(part, at), at + part.length), 0);
  return out.buffer;
};
const text = (words: string) => new TextEncoder().encode(words);

test('a preview is a line of JSON and a map', () => {
  const line = JSON.stringify({ coverage: 0.5, warnings: [{ message: 'zu große Öffnung' }] });
  const filled = text(line);
  const pad = text(' '.repeat((16 - (filled.length % 8) - 1) % 8) + '\n');
  const map = new Uint8Array(Float32Array.of(1, 2, 3, NaN).buffer);
  const read = previewOf(joined([filled, pad, map]));
  expect(read.ok && read.value.coverage).toBe(0.5);
  expect(read.ok && [...read.value.map]).toEqual([1, 2, 3, NaN]);
});

test.each([text(''), text('{"coverage": 1'), text('{}\nabc')])(
  'a broken preview is an error in words',
  (bytes) => {
    const read = previewOf(joined([bytes]));
    expect(!read.ok && read.failure.what).toBe('the preview cannot be read');
  },
);

afterEach(() => vi.unstubAllGlobals());

/** The extras of a model, with the names of the .proto file. */
const kExtras = {
  format: 'OBJ',
  scale: 10,
  lowest_mm: [1000, 0, 0],
  highest_mm: [1010, 20, 0],
  has_colour: true,
  companions: [{ name: 'my_skin.png', is_missing: true }],
};

/**
 * A binary glTF of three primitives that share their vertices; the second vertex and the last are at one place. The first
 * primitive has a factor, the others a picture each. It is what `inspect` writes.
 */
function glb(extras: object = kExtras): ArrayBuffer {
  const floats = (...numbers: number[]) => new Uint8Array(Float32Array.from(numbers).buffer);
  const views = [
    floats(0, 0, 0, 10, 0, 0, 0, 20, 0, 10, 0, 0),
    floats(0, 1, 2, 1),
    floats(0, 0, 1, 0, 0, 0.75, 1, 0),
    new Uint8Array(
      Uint16Array.from({ length: 16 }, (_, i) => (i % 4 === 3 ? 65535 : 1000 * i)).buffer,
    ),
    new Uint8Array(Uint32Array.of(0, 1, 2, 2, 3, 0).buffer),
    Uint8Array.of(7, 8, 9, 0),
    Uint8Array.of(1, 2, 3, 4),
  ];
  let at = 0;
  const bufferViews = views.map(({ length }) => {
    at += length;
    return { buffer: 0, byteOffset: at - length, byteLength: length };
  });
  const attributes = { POSITION: 0, _PLACE: 1, TEXCOORD_0: 2, COLOR_0: 3 };
  const unlit = { KHR_materials_unlit: {} };
  const surface = (more: object) => ({ pbrMetallicRoughness: more, extensions: unlit });
  const accessor = (bufferView: number, componentType: number, count: number, type: string) => ({
    ...{ bufferView, componentType, count, type },
    ...(bufferView === 0 ? { min: [0, 0, 0], max: [10, 20, 0] } : {}),
    ...(componentType === 5123 ? { normalized: true } : {}),
  });
  const json = {
    asset: { version: '2.0', extras },
    extensionsUsed: ['KHR_materials_unlit'],
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, translation: [1000, 0, 0] }],
    meshes: [
      {
        primitives: [
          { attributes, indices: 4, material: 0 },
          { attributes, indices: 5, material: 1 },
          { attributes, indices: 4, material: 2 },
        ],
      },
    ],
    materials: [
      surface({ baseColorFactor: [0.25, 0.5, 1, 1] }),
      surface({ baseColorTexture: { index: 1 } }),
      surface({ baseColorTexture: { index: 0 } }),
    ],
    textures: [
      { source: 1, sampler: 1 },
      { source: 0, sampler: 0 },
    ],
    samplers: [
      { wrapS: 33071, wrapT: 33648 },
      { wrapS: 33648, wrapT: 10497 },
    ],
    images: [
      { bufferView: 5, mimeType: 'image/png' },
      { bufferView: 6, mimeType: 'image/jpeg' },
    ],
    accessors: [
      accessor(0, 5126, 4, 'VEC3'),
      accessor(1, 5126, 4, 'SCALAR'),
      accessor(2, 5126, 4, 'VEC2'),
      accessor(3, 5123, 4, 'VEC4'),
      accessor(4, 5125, 3, 'SCALAR'),
      { ...accessor(4, 5125, 3, 'SCALAR'), byteOffset: 12 },
    ],
    bufferViews,
    buffers: [{ byteLength: at }],
  };
  const words = text(JSON.stringify(json));
  const padded = joined([words, text(' '.repeat((4 - (words.length % 4)) % 4))]);
  const head = (...numbers: number[]) => new Uint8Array(Uint32Array.from(numbers).buffer);
  return joined([
    head(0x46546c67, 2, 28 + padded.byteLength + at),
    head(padded.byteLength, 0x4e4f534a),
    new Uint8Array(padded),
    head(at, 0x004e4942),
    ...views,
  ]);
}

const kBitmap = { width: 2, height: 2 };
async function read(bytes: ArrayBuffer) {
  vi.stubGlobal(
    'createImageBitmap',
    vi.fn(async (blob: Blob) => ({
      ...kBitmap,
      bytes: [...new Uint8Array(await blob.arrayBuffer())],
    })),
  );
  const model = await modelOf(bytes);
  if (!model.ok) throw new Error(model.failure.what);
  return model.value;
}

test('the places of a model are in mm of the object frame, its mesh and box in units of the file', async () => {
  const { places, mesh, box, summary } = await read(glb());
  expect([...places.positions]).toEqual([1000, 0, 0, 1010, 0, 0, 1000, 20, 0]);
  expect([...places.corners]).toEqual([0, 1, 2, 2, 1, 0, 0, 1, 2]);
  expect([...mesh.positions]).toEqual([100, 0, 0, 101, 0, 0, 100, 2, 0, 101, 0, 0]);
  expect([...mesh.indices]).toEqual([0, 1, 2, 2, 3, 0, 0, 1, 2]);
  expect(box).toEqual({ min: [100, 0, 0], max: [101, 2, 0] });
  expect(summary).toEqual({
    format: 'OBJ',
    scale: 10,
    lowestMm: [1000, 0, 0],
    highestMm: [1010, 20, 0],
    hasColour: true,
    companions: [{ name: 'my_skin.png', isMissing: true }],
  });
});

test('its colours are in linear light without alpha, and v points up', async () => {
  const { mesh } = await read(glb());
  expect([...mesh.colours!.slice(0, 6)]).toEqual([0, 1000, 2000, 4000, 5000, 6000]);
  expect([...mesh.uvs!]).toEqual([0, 1, 1, 1, 0, 0.25, 1, 1]);
});

test('each part has its factor, or its picture with its wrap', async () => {
  const { mesh } = await read(glb());
  const [tinted, pictured, other] = mesh.parts;
  expect(tinted).toEqual({ look: { colour: [0.25, 0.5, 1] }, first: 0, count: 3 });
  expect(pictured).toMatchObject({ first: 3, count: 3 });
  expect(pictured!.look).toMatchObject({ colour: [1, 1, 1], wrap: ['clamp', 'mirror'] });
  expect(pictured!.look.picture).toMatchObject({ ...kBitmap, bytes: [7, 8, 9, 0] });
  expect(other).toMatchObject({ first: 6, count: 3, look: { wrap: ['mirror', 'repeat'] } });
  expect(other!.look.picture).toMatchObject({ bytes: [1, 2, 3, 4] });
});

test('a model without any colour is grey', async () => {
  const { mesh } = await read(glb({ ...kExtras, has_colour: false }));
  for (const { look } of mesh.parts) {
    expect(look.picture).toBeUndefined();
    expect(new Set(look.colour).size).toBe(1);
    expect(look.colour[0]).toBeLessThan(1);
  }
});

test('bytes that are not a glTF are an error in words', async () => {
  const model = await modelOf(joined([text('not a model')]));
  expect(!model.ok && model.failure.what).toBe('the model cannot be shown');
});
