import { describe, expect, test } from 'vitest';
import { axisDistances, type BoxLayer, type FineMesh } from '../src/paint/axis_distance';
import { axisOfTriangles, weld, type Axes } from '../src/paint/axis_edges';
import { hitOf } from '../src/paint/hit';
import { SegmentTree } from '../src/paint/segment_tree';

const kAxes: Axes = [
  [1, 0, 0],
  [0, 0, 1],
  [0, 1, 0],
];

/** A box from the origin to (20, 30, 40); each side has its own vertices. Vertices are repeated as in an STL file. */
function box() {
  const [x, y, z] = [20, 30, 40];
  const corner = (bits: number) => [bits & 1 ? x : 0, bits & 2 ? y : 0, bits & 4 ? z : 0];
  const sides = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
  ];
  const corners = sides.flatMap(([a, b, c, d]) => [a!, b!, c!, a!, c!, d!]);
  return {
    positions: Float32Array.from(corners.flatMap(corner)),
    indices: Uint32Array.from(corners, (_, i) => i),
  };
}

/** The positions of all vertices. */
function positionsOf(coarse: Float32Array, { parents }: FineMesh): number[] {
  const out = [...coarse];
  for (let i = 0; i < parents.length; i += 2)
    for (let k = 0; k < 3; k += 1)
      out.push((out[3 * parents[i]! + k]! + out[3 * parents[i + 1]! + k]!) / 2);
  return out;
}

function fine(layer: BoxLayer, most?: number) {
  const surface = box();
  const mesh = axisDistances(surface, [undefined, layer], most);
  return { mesh, at: positionsOf(surface.positions, mesh), distances: mesh.distances[1]! };
}

describe('the distances to the axes of a box', () => {
  test('are those to the edges around the sides of the axis', () => {
    const { mesh, at, distances } = fine({ axes: kAxes, blend_mm: 5 });
    expect(mesh.distances[0]).toBeUndefined();
    mesh.indices.forEach((vertex, i) => {
      const [x, y, z] = [at[3 * vertex]!, at[3 * vertex + 1]!, at[3 * vertex + 2]!];
      const side = Math.floor(mesh.sources[Math.floor(i / 3)]! / 4);
      const [r, u, d] = distances.subarray(3 * vertex, 3 * vertex + 3);
      const toX = Math.min(x, 20 - x, 10);
      const toY = Math.min(y, 30 - y, 10);
      const toZ = Math.min(z, 40 - z, 10);
      // Sides 0, 1, 2: below and above (along u), front and back (along d), left and right (along r).
      const expected = [
        [toX, 0, toY],
        [toX, toZ, 0],
        [0, toZ, toY],
      ][side]!;
      [r!, u!, d!].forEach((value, axis) => expect(value).toBeCloseTo(expected[axis]!, 4));
    });
  });

  test('come with edges of at most a sixth of the blend where axes blend, and coarser ones elsewhere', () => {
    const { mesh, at, distances } = fine({ axes: kAxes, blend_mm: 6 });
    let longest = 0;
    for (let i = 0; i < mesh.indices.length; i += 3) {
      const corners = [0, 1, 2].map((k) => mesh.indices[i + k]!);
      const isBlended = corners.some((v) => {
        const near = [...distances.subarray(3 * v, 3 * v + 3)].filter((d) => d < 6);
        return near.length > 1;
      });
      const length = (a: number, b: number) =>
        Math.hypot(...[0, 1, 2].map((k) => at[3 * a + k]! - at[3 * b + k]!));
      const most = Math.max(...corners.map((v, k) => length(v, corners[(k + 1) % 3]!)));
      if (isBlended) expect(most).toBeLessThanOrEqual(1 + 1e-9);
      longest = Math.max(longest, most);
    }
    expect(longest).toBeGreaterThan(4);
  });

  test('have no cracks: every edge has a triangle on both sides', () => {
    const { mesh, at } = fine({ axes: kAxes, blend_mm: 3 });
    const welded = weld(at);
    const ways = new Map<string, number>();
    const count = (a: number, b: number, by: number) =>
      ways.set(`${a} ${b}`, (ways.get(`${a} ${b}`) ?? 0) + by);
    mesh.indices.forEach((vertex, i) => {
      const next = mesh.indices[i % 3 === 2 ? i - 2 : i + 1]!;
      count(welded[vertex]!, welded[next]!, 1);
      count(welded[next]!, welded[vertex]!, -1);
    });
    expect([...ways.values()].every((sum) => sum === 0)).toBe(true);
    expect([...mesh.sources]).toEqual([...mesh.sources].sort((a, b) => a - b));
  });

  test('come with a coarser mesh if there would be too many triangles', () => {
    const { mesh } = fine({ axes: kAxes, blend_mm: 0.01 }, 5000);
    expect(mesh.sources.length).toBeGreaterThan(1000);
    expect(mesh.sources.length).toBeLessThanOrEqual(5000);
  });

  test('need no more triangles if no axes meet', () => {
    const square = {
      positions: Float32Array.from([0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0]),
      indices: Uint32Array.from([0, 1, 2, 0, 2, 3]),
    };
    const mesh = axisDistances(square, [{ axes: kAxes, blend_mm: 2 }]);
    expect([...mesh.indices]).toEqual([...square.indices]);
    expect([...mesh.distances[0]!.subarray(0, 3)]).toEqual([4, 0, 4]);
  });
});

test('a triangle belongs to the earlier one of axes that are equally near', () => {
  const slope = {
    positions: Float32Array.from([0, 0, 0, 0, 1, 0, -1, 0, 1, -1 - 1e-7, 0, 1]),
    indices: Uint32Array.from([0, 1, 2, 0, 1, 3]),
  };
  expect([...axisOfTriangles(slope, kAxes)]).toEqual([0, 0]);
});

test('vertices with the same position are welded, also 0 and -0', () => {
  expect([...weld([0, 1, 2, 5, 5, 5, -0, 1, 2, 0, 1, 2.5])]).toEqual([0, 1, 0, 3]);
});

test('the nearest of many segments is found', () => {
  let seed = 1;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  const ends = Float64Array.from({ length: 6 * 200 }, random);
  const tree = new SegmentTree(ends);
  const to = (p: number[], i: number) => {
    let best = Infinity;
    for (let t = 0; t <= 1; t += 2e-3)
      best = Math.min(
        best,
        Math.hypot(...p.map((x, k) => x - (1 - t) * ends[6 * i + k]! - t * ends[6 * i + 3 + k]!)),
      );
    return best;
  };
  for (let n = 0; n < 10; n += 1) {
    const p = [2 * random(), 2 * random(), random()];
    const expected = Math.min(...Array.from({ length: 200 }, (_, i) => to(p, i)));
    expect(tree.distance(p[0]!, p[1]!, p[2]!, 9)).toBeCloseTo(expected, 2);
    expect(tree.distance(p[0]!, p[1]!, p[2]!, expected / 2)).toBeCloseTo(expected / 2, 9);
  }
  expect(new SegmentTree(new Float64Array()).distance(0, 0, 0, 7)).toBe(7);
});

test('a ray hits the nearest triangle, with its outward normal', () => {
  const hit = hitOf(box(), [5, 6, 100], [0, 0, -3]);
  expect(hit).toEqual({ point: [5, 6, 40], normal: [0, 0, 1] });
  expect(hitOf(box(), [5, 6, 20], [0, -1, 0])?.normal).toEqual([0, -1, 0]);
  expect(hitOf(box(), [5, 6, 100], [0, 0, 1])).toBeUndefined();
  expect(hitOf(box(), [25, 6, 100], [0, 0, -1])).toBeUndefined();
});
