/** Finds the point of a mesh that a ray meets first. */
import type { Vec3 } from '../model/pose';

/** A mesh, and a point and an outward normal (length 1) of its surface, in units of the mesh. */
export interface Target {
  positions: Float32Array;
  indices: Uint32Array;
}
export interface Hit {
  point: Vec3;
  normal: Vec3;
}

/** Both sides of triangles are met. The normal is that of the triangle, whose corners are counter-clockwise from outside. */
export function hitOf(
  { positions: at, indices }: Target,
  from: Vec3,
  along: Vec3,
): Hit | undefined {
  const [ox, oy, oz] = from;
  const [dx, dy, dz] = along;
  let nearest = Infinity;
  let found = -1;
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [3 * indices[i]!, 3 * indices[i + 1]!, 3 * indices[i + 2]!];
    const x = at[a]!;
    const y = at[a + 1]!;
    const z = at[a + 2]!;
    const ux = at[b]! - x;
    const uy = at[b + 1]! - y;
    const uz = at[b + 2]! - z;
    const vx = at[c]! - x;
    const vy = at[c + 1]! - y;
    const vz = at[c + 2]! - z;
    // Moeller and Trumbore: the barycentric coordinates p, q and the distance t by Cramer's rule.
    const hx = dy * vz - dz * vy;
    const hy = dz * vx - dx * vz;
    const hz = dx * vy - dy * vx;
    const det = ux * hx + uy * hy + uz * hz;
    if (det === 0) continue;
    const [sx, sy, sz] = [ox - x, oy - y, oz - z];
    const p = (sx * hx + sy * hy + sz * hz) / det;
    if (p < 0 || p > 1) continue;
    const kx = sy * uz - sz * uy;
    const ky = sz * ux - sx * uz;
    const kz = sx * uy - sy * ux;
    const q = (dx * kx + dy * ky + dz * kz) / det;
    if (q < 0 || p + q > 1) continue;
    const t = (vx * kx + vy * ky + vz * kz) / det;
    if (t < 0 || t >= nearest) continue;
    nearest = t;
    found = i;
  }
  if (found < 0) return undefined;
  const point: Vec3 = [ox + nearest * dx, oy + nearest * dy, oz + nearest * dz];
  return { point, normal: normalOf(at, indices, found) };
}

function normalOf(at: Float32Array, indices: Uint32Array, first: number): Vec3 {
  const [a, b, c] = [3 * indices[first]!, 3 * indices[first + 1]!, 3 * indices[first + 2]!];
  const u = [0, 1, 2].map((k) => at[b + k]! - at[a + k]!) as [number, number, number];
  const v = [0, 1, 2].map((k) => at[c + k]! - at[a + k]!) as [number, number, number];
  const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const length = Math.hypot(...n);
  return [n[0]! / length, n[1]! / length, n[2]! / length];
}
