/** The shader's projections, run as JavaScript. */
import { describe, expect, test } from 'vitest';
import type { Vec3 } from '../src/model/pose';
import type { PaintLayer } from '../src/paint/layer';
import { place, type Placement } from '../src/paint/placement';
import { fragmentHead, vertexBody, vertexHead, type LayerKind } from '../src/paint/shader';
import { glsl, placeOf, vec } from './glsl';

const kSolid = {
  positions: Float32Array.from([-30, -20, -10, 30, -20, -10, 30, 20, 10, -30, 20, 10]),
  indices: Uint32Array.from([0, 1, 2, 0, 2, 3]),
};
const kPoints: Vec3[] = [
  [1, 2, 3],
  [-25, 14, -8],
  [12, -19, 6],
  [-3, -0.5, 9],
  [0.2, 17, -4],
];

const on = (layer: PaintLayer, aspect = 1.5): Placement =>
  place(layer, kSolid, [0.5, 0.5, -0.5, 0.5], aspect);
const dot = (a: Vec3, b: Vec3) => a.reduce((sum, value, i) => sum + value * b[i]!, 0);
/** q.r, q.u, q.d. */
function seen(at: Placement, p: Vec3): Vec3 {
  const q = p.map((value, i) => value - at.position_mm[i]!) as unknown as Vec3;
  return [dot(q, at.right), dot(q, at.up), dot(q, at.direction)];
}

/** Independent of the shader: turns the place back as a complex number, then mirrors it. */
function uvOf(at: Placement, s: number, t: number): [number, number] {
  const [length, angle] = [Math.hypot(s, t), Math.atan2(t, s) - at.turn_rad];
  const right = length * Math.cos(angle) * (at.mirror ? -1 : 1);
  return [0.5 + right / at.width_mm, 0.5 + (length * Math.sin(angle)) / at.height_mm];
}

function expectUv({ x, y }: { x: number; y: number }, [u, v]: [number, number]): void {
  expect(x).toBeCloseTo(u, 9);
  expect(y).toBeCloseTo(v, 9);
}

const kTurned = { direction: [0.4, 1, -0.3], turn_deg: 130, mirror: true, size_mm: 17 } as const;

describe('a point is projected', () => {
  test('along the direction of view, if the picture is flat', () => {
    for (const projection of ['planar', 'dip', 'decal'] as const)
      for (const p of kPoints) {
        const at = on({ ...kTurned, projection });
        const [s, t] = seen(at, p);
        expectUv(glsl.planarUv(placeOf(at), vec(p)), uvOf(at, s, t));
      }
  });

  test('along each axis of a box', () => {
    const at = on({ ...kTurned, projection: 'box' });
    for (const p of kPoints) {
      const [r, u, d] = seen(at, p);
      const places = [
        [d, u],
        [r, d],
        [r, u],
      ] as const;
      places.forEach(([s, t], axis) =>
        expectUv(glsl.boxUv(placeOf(at), vec(p), axis), uvOf(at, s, t)),
      );
    }
  });

  test('around a cylinder, from the side that faces the viewer', () => {
    const at = on({ projection: 'cylindrical', turn_deg: 70, repeat: false, size_mm: 31 });
    const point = (angle: number): Vec3 =>
      [0, 1, 2].map(
        (i) =>
          at.position_mm[i]! +
          8 * Math.sin(angle) * at.right[i]! -
          8 * Math.cos(angle) * at.direction[i]! +
          3 * at.up[i]!,
      ) as unknown as Vec3;
    for (const angle of [-1.7, -0.4, 0, 1.2, 3, 4.2]) {
      const s = (angle - (70 * Math.PI) / 180) * at.radius_mm;
      expectUv(glsl.cylinderUv(placeOf(at), vec(point(angle))), [
        0.5 + s / 31,
        0.5 + 3 / at.height_mm,
      ]);
    }
  });
});

test('the change of a place around a cylinder is its derivative, also across the seam', () => {
  const at = placeOf(on({ projection: 'cylindrical', mirror: true }));
  const step: Vec3 = [1e-5, -2e-5, 3e-5];
  for (const p of kPoints) {
    const [from, to] = [p, p.map((value, i) => value + step[i]!) as unknown as Vec3];
    const [a, b] = [glsl.cylinderUv(at, vec(from)), glsl.cylinderUv(at, vec(to))];
    const change = glsl.cylinderChange(at, vec(p), vec(step));
    expect(change.x).toBeCloseTo(b.x - a.x, 8);
    expect(change.y).toBeCloseTo(b.y - a.y, 8);
  }
  const behind = glsl.cylinderChange(at, vec([0, 15, 0]), vec([0.1, 0, 0]));
  expect(Math.abs(behind.x)).toBeLessThan(0.002);
  expect(glsl.cylinderChange(at, vec([0, 0, 1]), vec([0.1, 0, 0])).y).toBe(0);
});

test('the weight of an axis falls smoothly to 0 over the width of the blend', () => {
  expect([0, 1, 2, 4, 9].map((d) => glsl.boxWeight(d, 4))).toEqual([1, 0.84375, 0.5, 0, 0]);
});

test('the border of a decal is as wide as a pixel', () => {
  const shares = [-0.6, -0.5, 0, 0.475, 0.5, 0.525, 0.6].map((x) => glsl.insideDecal(x, 0.1));
  [0, 0.5, 1, 0.75, 0.5, 0.25, 0].forEach((share, i) => expect(shares[i]).toBeCloseTo(share, 9));
  expect([0.4, 0.6].map((x) => glsl.insideDecal(x, 0))).toEqual([1, 0]);
});

test('the source text declares and uses what each kind of layer needs', () => {
  const kinds: LayerKind[] = [
    { projection: 'box', shows: 'picture' },
    { projection: 'decal', shows: 'colour' },
    { projection: 'uv', shows: 'own' },
    { projection: 'vertex_colors', shows: 'colour' },
  ];
  const text = fragmentHead(kinds);
  expect(text).toContain('boxPicture(picture0, place0, vDistances0), opacity0)');
  expect(text).toContain('vec4(colour1, 1.0), opacity1 * decalShare(place1))');
  expect(text).toContain('vec4(ownLook(), 1.0), opacity2)');
  expect(text).toContain('vec4(vOwnColour, 1.0), opacity3)');
  expect(text).not.toContain('sampler2D picture1');
  expect(vertexHead(kinds)).toContain('attribute vec3 distances0;');
  expect(vertexBody(kinds)).toContain('vDistances0 = distances0;');
  expect(vertexHead(kinds.slice(1))).not.toContain('distances');
});
