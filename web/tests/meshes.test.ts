import { describe, expect, test } from 'vitest';
import { boxOf } from '../src/model/mesh';
import { attempt, Refusal } from '../src/model/result';
import { placesOf, readSurfaceMap } from '../src/model/surface_map';

const bytesOf = (text: string): ArrayBuffer => new TextEncoder().encode(text).buffer as ArrayBuffer;

/** One triangle as a binary surface map, with the stretch of each vertex; NaN means that the film does not reach it. */
function surfaceMap(stretch: number[], flags = 0): ArrayBuffer {
  const head =
    'ply\nformat binary_little_endian 1.0\nelement vertex 3\n' +
    ['x', 'y', 'z', 'film_x', 'film_y', 'contact_time', 'stretch']
      .map((name) => `property double ${name}\n`)
      .join('') +
    'element face 1\nproperty list uchar int vertex_indices\nproperty uchar flags\nend_header\n';
  const out = new Uint8Array(head.length + 3 * 7 * 8 + 14);
  out.set(new TextEncoder().encode(head));
  const view = new DataView(out.buffer, head.length);
  const corners = [
    [0, 0, 0],
    [10, 0, 0],
    [0, 10, 0],
  ];
  corners.forEach(([x, y, z], i) =>
    [x!, y!, z!, 2 * x!, 2 * y!, 3 * i, stretch[i]!].forEach((value, k) =>
      view.setFloat64(56 * i + 8 * k, value, true),
    ),
  );
  view.setUint8(168, 3);
  [0, 1, 2].forEach((index, i) => view.setInt32(169 + 4 * i, index, true));
  view.setUint8(181, flags);
  return out.buffer;
}

describe('a surface map', () => {
  const text =
    'ply\nformat ascii 1.0\nelement vertex 4\n' +
    ['x', 'y', 'z', 'film_x', 'film_y', 'contact_time', 'stretch']
      .map((name) => `property float ${name}\n`)
      .join('') +
    'element face 1\nproperty list uchar int vertex_index\nend_header\n' +
    '0 0 0 0 0 1 1\n1 0 0 2 0 1 1\n1 1 0 2 2 1 1\n0 1 0 0 2 1 1\n4 0 1 2 3\n';

  test('may be text, and a quad is two triangles', () => {
    expect([...readSurfaceMap(bytesOf(text)).indices]).toEqual([0, 1, 2, 0, 2, 3]);
  });

  test.each([
    ['no header', 'hello'],
    ['more rows than bytes', text.replace('vertex 4', 'vertex 400000000')],
    ['a negative count', text.replace('vertex 4', 'vertex -4')],
    ['an unknown type', text.replace('float x', 'quad x')],
    ['missing data at the end', text.slice(0, -8)],
    ['no faces', text.replace('vertex_index', 'neighbours')],
    ['no film', text.replace('film_x', 'x_film')],
    ['a vertex that does not exist', text.replace('4 0 1 2 3', '4 0 1 2 4')],
  ])('with %s is refused', (_, broken) => {
    expect(attempt(() => readSurfaceMap(bytesOf(broken))).ok).toBe(false);
  });

  test('has film positions, times and stretch', () => {
    const map = readSurfaceMap(surfaceMap([1, 1.5, 4]));
    expect([...map.film_mm]).toEqual([0, 0, 20, 0, 0, 20]);
    expect([...map.stretch]).toEqual([1, 1.5, 4]);
    expect(map.contactMax_s).toBe(6);
    expect(map.box.max).toEqual([10, 10, 0]);
  });

  test('has a stated error if the file has one', () => {
    expect(readSurfaceMap(bytesOf(text)).error_mm).toBeUndefined();
    const stated = text
      .replace('float stretch\n', 'float stretch\nproperty float error_mm\n')
      .replaceAll(' 1 1\n', ' 1 1 0.02\n');
    expect(readSurfaceMap(bytesOf(stated)).error_mm).toHaveLength(4);
    expect(readSurfaceMap(bytesOf(stated)).error_mm?.[1]).toBeCloseTo(0.02);
  });

  test.each([
    ['FILM_TORN', 1],
    ['FILM_WRINKLED', 2],
    ['THETA_CLAMPED', 4],
    ['PARTS_NOT_REACHED', 8],
    ['FILM_EDGE_REACHED', 8],
    ['AIR_TRAPPED', 16],
    ['STRETCH_BEYOND_STOKES', 0],
  ])('the warning %s selects the triangles with its flag', (code, flag) => {
    expect(placesOf(code, readSurfaceMap(surfaceMap([1, 4, NaN], flag)))).toEqual(flag ? [0] : []);
    expect(placesOf(code, readSurfaceMap(surfaceMap([1, 4, NaN], 63 - flag)))).toEqual([]);
  });

  test('without flags has no triangles for warnings', () => {
    expect(placesOf('FILM_TORN', readSurfaceMap(bytesOf(text)))).toEqual([]);
  });

  test('is refused if it is incomplete', () => {
    expect(() => readSurfaceMap(surfaceMap([1, 1, 1]).slice(0, -1))).toThrow(Refusal);
  });
});

test('a box needs triangles', () => {
  const positions = Float32Array.of(0, 0, 0, 2, 0, 0, 0, 3, 0);
  expect(boxOf({ positions, indices: Uint32Array.of(0, 1, 2) }).max).toEqual([2, 3, 0]);
  expect(() => boxOf({ positions, indices: new Uint32Array() })).toThrow(Refusal);
});
