/** Compares the shader's projections with places computed by tests/foreign/projection, from the definition alone. */
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import type { Quaternion, Vec3 } from '../src/model/pose';
import { axisDistances } from '../src/paint/axis_distance';
import { layerOf, type LayerSpec } from '../src/paint/layer';
import { place, type Placement } from '../src/paint/placement';
import { glsl, placeOf, vec } from './glsl';

type Uv = [number, number];

interface Solid {
  points_mm: Vec3[];
  triangles: Vec3[];
}
interface Case {
  name: string;
  object: string;
  /** Keys as in spec.proto. */
  layer: Record<string, unknown>;
  picture: { width_px: number; height_px: number };
  rotation_wxyz: Quaternion;
  r: Vec3;
  u: Vec3;
  d: Vec3;
  position_mm: Vec3;
  width_mm: number;
  height_mm: number;
  repeats: boolean;
  radius_mm?: number;
  blend_mm?: number;
  points_mm: Vec3[];
  normals: Vec3[];
  uv: Uv[] | Uv[][];
  weights?: Vec3[];
  shown?: boolean[];
}
interface Expected {
  objects: Record<string, Solid>;
  cases: Case[];
}

/** Runs the judge; undefined without Python and NumPy. */
function judge(): Expected | undefined {
  const script = new URL('../../tests/foreign/projection/judge.py', import.meta.url);
  const folder = mkdtempSync(join(tmpdir(), 'judge-'));
  const file = join(folder, 'expected.json');
  try {
    execFileSync('/usr/bin/python3', ['-c', 'import numpy'], { stdio: 'ignore' });
  } catch {
    return undefined;
  }
  execFileSync('/usr/bin/python3', [fileURLToPath(script), '--write-expected', file]);
  const expected = JSON.parse(readFileSync(file, 'utf8')) as Expected;
  rmSync(folder, { recursive: true });
  return expected;
}

const camel = (key: string) => key.replace(/_(\w)/g, (_, letter: string) => letter.toUpperCase());

function placed({ layer, picture, rotation_wxyz }: Case, { points_mm, triangles }: Solid) {
  const spec = Object.fromEntries(Object.entries(layer).map(([key, value]) => [camel(key), value]));
  const solid = {
    positions: Float32Array.from(points_mm.flat()),
    indices: Uint32Array.from(triangles.flat()),
  };
  const aspect = picture.width_px / picture.height_px;
  return place(layerOf(spec as LayerSpec, 'dip'), solid, rotation_wxyz, aspect);
}

function expectPlacement(at: Placement, one: Case): void {
  const close = (found: Vec3, expected: Vec3, digits: number) =>
    found.forEach((value, i) => expect(value).toBeCloseTo(expected[i]!, digits));
  close(at.right, one.r, 7);
  close(at.up, one.u, 7);
  close(at.direction, one.d, 7);
  // Positions of the mesh have 32 bits.
  close(at.position_mm, one.position_mm, 5);
  expect(at.width_mm).toBeCloseTo(one.width_mm, 4);
  expect(at.height_mm).toBeCloseTo(one.height_mm, 4);
  expect(at.repeat).toBe(one.repeats);
  if (one.radius_mm) expect(at.radius_mm).toBeCloseTo(one.radius_mm, 5);
  if (one.blend_mm) expect(at.blend_mm).toBeCloseTo(one.blend_mm, 5);
}

function expectUvs(at: Placement, one: Case): void {
  const [uniform, around] = [placeOf(at), (2 * Math.PI * at.radius_mm) / at.width_mm];
  const near = (found: { x: number; y: number }, [u, v]: Uv) => {
    const turns = at.projection === 'cylindrical' ? Math.round((found.x - u) / around) : 0;
    expect(found.x - turns * around).toBeCloseTo(u, 5);
    expect(found.y).toBeCloseTo(v, 5);
  };
  one.points_mm.forEach((p, i) => {
    const uv = one.uv[i]!;
    if (at.projection === 'box')
      (uv as Uv[]).forEach((each, axis) => near(glsl.boxUv(uniform, vec(p), axis), each));
    else if (at.projection === 'cylindrical') near(glsl.cylinderUv(uniform, vec(p)), uv as Uv);
    else near(glsl.planarUv(uniform, vec(p)), uv as Uv);
  });
}

const minus = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** A triangle with its longest edge. */
interface Piece {
  corners: [Vec3, Vec3, Vec3];
  longest: number;
}

function pieceOf(a: Vec3, b: Vec3, c: Vec3): Piece {
  const edges = [minus(a, b), minus(b, c), minus(c, a)];
  return { corners: [a, b, c], longest: Math.max(...edges.map((edge) => Math.hypot(...edge))) };
}

/** A function for the distances at points of the surface, as the shader interpolates them. */
function distancesOf(at: Placement, { points_mm, triangles }: Solid): (p: Vec3) => Vec3 {
  const axes = [at.right, at.up, at.direction] as const;
  const surface = { positions: points_mm.flat(), indices: triangles.flat() };
  const mesh = axisDistances(surface, [{ axes, blend_mm: at.blend_mm }]);
  const points = [...points_mm];
  for (let i = 0; i < mesh.parents.length; i += 2) {
    const [a, b] = [points[mesh.parents[i]!]!, points[mesh.parents[i + 1]!]!];
    points.push([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2]);
  }
  const corners = (t: number) => [...mesh.indices.subarray(3 * t, 3 * t + 3)];
  const pieces = Array.from(mesh.sources, (_, t) => {
    const [a, b, c] = corners(t).map((vertex) => points[vertex]!);
    return pieceOf(a!, b!, c!);
  });
  return (p) => {
    const { triangle, shares } = find(p, pieces);
    const mean = (axis: number) =>
      corners(triangle).reduce(
        (sum, vertex, k) => sum + shares[k]! * mesh.distances[0]![3 * vertex + axis]!,
        0,
      );
    return [mean(0), mean(1), mean(2)];
  };
}

/** The triangle at a point, and the barycentric coordinates of the point. */
function find(p: Vec3, pieces: Piece[]) {
  let best = { miss: Infinity, shares: [1, 0, 0], triangle: 0 };
  pieces.forEach(({ corners: [a, b, c], longest }, triangle) => {
    // No point of a triangle is further from a corner than the longest edge.
    if (p.some((value, k) => Math.abs(value - a[k]!) > 1.01 * longest)) return;
    const [u, v, w] = [minus(b, a), minus(c, a), minus(p, a)];
    const [uu, uv, vv, wu, wv] = [dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v)];
    const det = uu * vv - uv * uv;
    const [s, t] = [(vv * wu - uv * wv) / det, (uu * wv - uv * wu) / det];
    const off = w.map((value, k) => value - s * u[k]! - t * v[k]!);
    const miss = Math.hypot(...off) + Math.max(0, -s, -t, s + t - 1) * longest;
    if (miss < best.miss) best = { miss, shares: [1 - s - t, s, t], triangle };
  });
  return best;
}

/** Between vertices the distances are interpolated, which rounds the edges of their graph. */
function expectWeights(at: Placement, one: Case, solid: Solid): void {
  const distances = distancesOf(at, solid);
  const errors = one.points_mm.flatMap((p, i) => {
    const weights = distances(p).map((distance) => glsl.boxWeight(distance, at.blend_mm));
    const sum = weights.reduce((a, b) => a + b);
    return weights.map((weight, axis) => Math.abs(weight / sum - one.weights![i]![axis]!));
  });
  expect(Math.max(...errors)).toBeLessThan(0.03);
  expect(errors.reduce((a, b) => a + b) / errors.length).toBeLessThan(0.001);
}

function expectShown(at: Placement, one: Case): void {
  const uniform = placeOf(at);
  one.points_mm.forEach((p, i) => {
    const { x, y } = glsl.planarUv(uniform, vec(p));
    const depth = at.depth_mm > 0 ? glsl.seenPoint(uniform, vec(p)).z / at.depth_mm : 0;
    const inside = [x - 0.5, y - 0.5, depth].every((value) => glsl.insideDecal(value, 0) === 1);
    expect(inside && dot(one.normals[i]!, at.direction) < 0).toBe(one.shown![i]);
  });
}

const expected = judge();

describe.skipIf(!expected)('the shader agrees with the foreign judge', () => {
  for (const one of expected?.cases ?? [])
    test(`${one.name}: the place, and ${one.points_mm.length} points`, () => {
      const solid = expected!.objects[one.object]!;
      const at = placed(one, solid);
      expectPlacement(at, one);
      expectUvs(at, one);
      if (one.weights) expectWeights(at, one, solid);
      if (one.shown) expectShown(at, one);
    });
});
