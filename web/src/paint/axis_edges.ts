/** The triangles of each axis of a 'box' layer, and the edges at which they meet others. */
import type { Vec3 } from '../model/pose';

/** r, u, d in frame O; orthonormal. */
export type Axes = readonly [Vec3, Vec3, Vec3];

/** A mesh in mm. */
export interface Surface {
  positions: ArrayLike<number>;
  indices: ArrayLike<number>;
}

/** Difference of cosines below which two axes are equally near. */
const kEqual = 1e-6;

/** The first vertex with the same position, of each vertex. */
export function weld(positions: ArrayLike<number>): Uint32Array {
  const count = positions.length / 3;
  const out = new Uint32Array(count);
  const size = 2 ** Math.ceil(Math.log2(2 * count + 2));
  const table = new Int32Array(size).fill(-1);
  const floats = new Float32Array(3);
  const bits = new Int32Array(floats.buffer);
  const isSame = (a: number, b: number) =>
    positions[3 * a] === positions[3 * b] &&
    positions[3 * a + 1] === positions[3 * b + 1] &&
    positions[3 * a + 2] === positions[3 * b + 2];
  for (let i = 0; i < count; i += 1) {
    // Adding 0 turns -0 into 0.
    for (let k = 0; k < 3; k += 1) floats[k] = positions[3 * i + k]! + 0;
    let hash = Math.imul(bits[0]!, 73856093) ^ Math.imul(bits[1]!, 19349663);
    hash = Math.imul(hash ^ Math.imul(bits[2]!, 83492791), 0x9e3779b1);
    let at = (hash ^ (hash >>> 15)) & (size - 1);
    while (table[at]! >= 0 && !isSame(table[at]!, i)) at = (at + 1) & (size - 1);
    if (table[at]! < 0) table[at] = i;
    out[i] = table[at]!;
  }
  return out;
}

/** The axis with which the normal of each triangle encloses the smallest angle; the earlier one of equals. */
export function axisOfTriangles({ positions, indices }: Surface, axes: Axes): Uint8Array {
  const out = new Uint8Array(indices.length / 3);
  for (let t = 0; t < out.length; t += 1) {
    const normal = normalOf(positions, indices[3 * t]!, indices[3 * t + 1]!, indices[3 * t + 2]!);
    const length = Math.hypot(...normal);
    const cosines = axes.map(
      (a) => Math.abs(a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2]) / length,
    );
    let best = 0;
    for (let a = 1; a < 3; a += 1) if (cosines[a]! > cosines[best]! + kEqual) best = a;
    out[t] = best;
  }
  return out;
}

function normalOf(at: ArrayLike<number>, a: number, b: number, c: number): Vec3 {
  const [x, y, z] = [at[3 * a]!, at[3 * a + 1]!, at[3 * a + 2]!];
  const [ux, uy, uz] = [at[3 * b]! - x, at[3 * b + 1]! - y, at[3 * b + 2]! - z];
  const [vx, vy, vz] = [at[3 * c]! - x, at[3 * c + 1]! - y, at[3 * c + 2]! - z];
  return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}

/**
 * The edges at which triangles of an axis meet others: x, y, z of both ends, per axis.
 * @param welded  from weld()
 * @param axisOf  from axisOfTriangles()
 */
export function endsOfAxes(
  { positions, indices }: Surface,
  welded: Uint32Array,
  axisOf: Uint8Array,
): [Float64Array, Float64Array, Float64Array] {
  const ends: [number[], number[], number[]] = [[], [], []];
  const keys = edgeKeys(indices, welded, axisOf);
  for (let i = 0; i < keys.length; ) {
    const edge = Math.floor(keys[i]! / 4);
    let axes = 0;
    for (; i < keys.length && Math.floor(keys[i]! / 4) === edge; i += 1) axes |= 1 << keys[i]! % 4;
    if ((axes & (axes - 1)) === 0) continue;
    const [a, b] = [Math.floor(edge / welded.length), edge % welded.length];
    for (let axis = 0; axis < 3; axis += 1)
      if ((axes >> axis) & 1)
        for (const vertex of [a, b])
          for (let k = 0; k < 3; k += 1) ends[axis]!.push(positions[3 * vertex + k]!);
  }
  return [Float64Array.from(ends[0]), Float64Array.from(ends[1]), Float64Array.from(ends[2])];
}

/** Sorted: per triangle and edge, 4 times the edge (the smaller end times the number of vertices, plus the larger), plus the axis. */
function edgeKeys(
  indices: ArrayLike<number>,
  welded: Uint32Array,
  axisOf: Uint8Array,
): Float64Array {
  const keys = new Float64Array(indices.length);
  for (let i = 0; i < keys.length; i += 1) {
    const triangle = Math.floor(i / 3);
    const a = welded[indices[i]!]!;
    const b = welded[indices[3 * triangle + ((i + 1) % 3)]!]!;
    keys[i] = 4 * (Math.min(a, b) * welded.length + Math.max(a, b)) + axisOf[triangle]!;
  }
  return keys.sort();
}

/** The set of axes of the triangles at each vertex: bit a for axis a. */
export function axesAtVertices(
  indices: ArrayLike<number>,
  welded: Uint32Array,
  axisOf: Uint8Array,
): Uint8Array {
  const sets = new Uint8Array(welded.length);
  for (let i = 0; i < indices.length; i += 1)
    sets[welded[indices[i]!]!]! |= 1 << axisOf[Math.floor(i / 3)]!;
  return sets.map((_, i) => sets[welded[i]!]!);
}
