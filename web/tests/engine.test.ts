import { expect, test } from 'vitest';
import { previewOf } from '../src/engine/daemon';
import { placesOf } from '../src/engine/places';

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

/** A binary glTF of two primitives that share their vertices; the second vertex and the last are at one place. */
function glb(): ArrayBuffer {
  const positions = Float32Array.of(0, 0, 0, 10, 0, 0, 0, 20, 0, 10, 0, 0);
  const places = Float32Array.of(0, 1, 2, 1);
  const indices = Uint32Array.of(0, 1, 2, 2, 3, 0);
  const views = [positions, places, indices].map(({ buffer }) => new Uint8Array(buffer));
  let at = 0;
  const bufferViews = views.map(({ length }) => {
    at += length;
    return { buffer: 0, byteOffset: at - length, byteLength: length };
  });
  const attributes = { POSITION: 0, _PLACE: 1 };
  const json = {
    asset: { version: '2.0' },
    extensionsUsed: ['KHR_materials_unlit'],
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, translation: [1000, 0, 0] }],
    meshes: [
      {
        primitives: [
          { attributes, indices: 2, material: 0 },
          { attributes, indices: 3 },
        ],
      },
    ],
    materials: [{ extensions: { KHR_materials_unlit: {} } }],
    accessors: [
      {
        bufferView: 0,
        componentType: 5126,
        count: 4,
        type: 'VEC3',
        min: [0, 0, 0],
        max: [10, 20, 0],
      },
      { bufferView: 1, componentType: 5126, count: 4, type: 'SCALAR' },
      { bufferView: 2, componentType: 5125, count: 3, type: 'SCALAR' },
      { bufferView: 2, byteOffset: 12, componentType: 5125, count: 3, type: 'SCALAR' },
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

test('the places of a binary glTF have positions in mm of the object frame', async () => {
  const read = await placesOf(glb());
  if (!read.ok) throw new Error(read.failure.what);
  expect([...read.value.positions]).toEqual([1000, 0, 0, 1010, 0, 0, 1000, 20, 0]);
  expect([...read.value.corners]).toEqual([0, 1, 2, 2, 1, 0]);
});

test('bytes that are not a glTF are an error in words', async () => {
  const read = await placesOf(joined([text('not a model')]));
  expect(!read.ok && read.failure.what).toBe('the model cannot be shown');
});
