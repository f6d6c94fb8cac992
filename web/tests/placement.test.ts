import { describe, expect, test } from 'vitest';
import { turn, type Quaternion, type Vec3 } from '../src/model/pose';
import { layerOf, layerSpec, type PaintLayer } from '../src/paint/layer';
import { place, type Placement } from '../src/paint/placement';

const kNone: Quaternion = [1, 0, 0, 0];
/** Corners of a box from (10, 0, 0) to (14, 2, 1); the last vertex belongs to no triangle. */
const kBox = {
  positions: Float32Array.from([10, 0, 0, 14, 0, 0, 14, 2, 0, 10, 2, 1, 99, 99, 99]),
  indices: Uint32Array.from([0, 1, 2, 0, 2, 3]),
};

const on = (layer: PaintLayer, aspect = 1, rotation = kNone): Placement =>
  place(layer, kBox, rotation, aspect);
const close = (found: Vec3, expected: number[]) =>
  found.forEach((value, i) => expect(value).toBeCloseTo(expected[i]!, 9));

describe('a picture without choices', () => {
  test('is seen from below: its right is -x, its up is y, its middle is that of the box', () => {
    const at = on({ projection: 'planar' });
    close(at.right, [-1, 0, 0]);
    close(at.up, [0, 1, 0]);
    close(at.direction, [0, 0, 1]);
    close(at.position_mm, [12, 1, 0.5]);
    expect([at.repeat, at.mirror, at.depth_mm, at.turn_rad]).toEqual([false, false, 0, 0]);
  });

  test('is seen from the front around a cylinder and on a box, and repeats there', () => {
    for (const projection of ['cylindrical', 'box'] as const) {
      const at = on({ projection });
      close(at.right, [1, 0, 0]);
      close(at.up, [0, 0, 1]);
      close(at.direction, [0, 1, 0]);
      expect(at.repeat).toBe(true);
    }
  });

  test('covers the object with its shorter side; a decal fits in with its longer side', () => {
    const size = (projection: 'planar' | 'decal', aspect: number) => {
      const { width_mm, height_mm } = on({ projection }, aspect);
      return [width_mm, height_mm];
    };
    expect(size('planar', 2)).toEqual([8, 4]);
    expect(size('planar', 0.5)).toEqual([4, 8]);
    expect(size('decal', 2)).toEqual([4, 2]);
    expect(size('decal', 0.5)).toEqual([2, 4]);
  });

  test('goes around a cylinder once', () => {
    const at = on({ projection: 'cylindrical' }, 3);
    expect(at.radius_mm).toBe(2);
    expect(at.width_mm).toBeCloseTo(4 * Math.PI, 9);
    expect(at.height_mm).toBeCloseTo((4 * Math.PI) / 3, 9);
  });

  test('blends on a box over a tenth of the largest side', () => {
    expect(on({ projection: 'box', direction: [0, 0, 1] }).blend_mm).toBeCloseTo(0.4, 9);
  });
});

describe('choices for a picture', () => {
  test('repeat it a whole number of times around a cylinder, at least once', () => {
    const width = (size_mm: number, repeat?: boolean) =>
      on({ projection: 'cylindrical', size_mm, repeat }).width_mm;
    expect(width(5)).toBeCloseTo((4 * Math.PI) / 3, 9);
    expect(width(100)).toBeCloseTo(4 * Math.PI, 9);
    expect(width(5, false)).toBe(5);
  });

  test('may have directions of any length, of which up is exact around a cylinder', () => {
    const seen: PaintLayer = { projection: 'planar', direction: [0, 3, 0], up: [0, 5, 5] };
    close(on(seen).up, [0, 0, 1]);
    close(on(seen).direction, [0, 1, 0]);
    close(on({ ...seen, projection: 'cylindrical' }).up, [0, Math.SQRT1_2, Math.SQRT1_2]);
    close(on({ ...seen, projection: 'cylindrical' }).direction, [0, Math.SQRT1_2, -Math.SQRT1_2]);
  });

  test('have y as up if the direction is within a degree of z', () => {
    close(on({ projection: 'planar', direction: [0, 0.01, -1] }).up, [
      0,
      1 / Math.hypot(1, 0.01),
      0.01 / Math.hypot(1, 0.01),
    ]);
    expect(on({ projection: 'planar', direction: [0, 0.1, -1] }).up[2]).toBeGreaterThan(0.09);
  });

  test('cannot have an up along the direction of view, or directions without length', () => {
    expect(() => on({ projection: 'decal', direction: [1, 0, 0], up: [-2, 0.01, 0] })).toThrow(
      'parallel',
    );
    expect(() => on({ projection: 'decal', direction: [0, 0, 0] })).toThrow('no length');
  });

  test('follow the film along the dip; other directions stay with the object', () => {
    const rotation = turn('z', 90);
    // x of the film is -y of the object.
    close(on({ projection: 'dip' }, 1, rotation).right, [0, 1, 0]);
    close(on({ projection: 'dip', direction: [1, 0, 0] }, 1, rotation).direction, [0, 0, 1]);
    close(on({ projection: 'planar' }, 1, rotation).right, [-1, 0, 0]);
  });

  test('are in mm, also if the mesh is not', () => {
    const at = place({ projection: 'planar' }, { ...kBox, scale: 10 }, kNone, 1);
    close(at.position_mm, [120, 10, 5]);
    expect(at.width_mm).toBe(40);
  });
});

test('a mesh that is a single point has places', () => {
  const point = { positions: new Float32Array(3), indices: Uint32Array.of(0, 0, 0) };
  expect(place({ projection: 'planar' }, point, kNone, 1).width_mm).toBe(1e-6);
});

test('a layer in a spec has only the fields that were chosen, and is read back', () => {
  expect(layerSpec({ projection: 'dip', mirror: false })).toEqual({ projection: 'dip' });
  const layer: PaintLayer = {
    projection: 'decal',
    position_mm: [1, 2, 3],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    size_mm: 20,
    depth_mm: 4,
    turn_deg: -30,
    mirror: true,
    repeat: false,
    opacity: 0,
    blend_mm: 2,
  };
  expect(layerSpec(layer)).toEqual({
    projection: 'decal',
    positionMm: [1, 2, 3],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    sizeMm: 20,
    depthMm: 4,
    turnDeg: -30,
    mirror: true,
    repeat: false,
    opacity: 0,
    blendMm: 2,
  });
  expect(layerOf(layerSpec(layer), 'dip')).toEqual(layer);
  expect(layerOf({ positionMm: [] }, 'uv')).toEqual({ projection: 'uv' });
});
