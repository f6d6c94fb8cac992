import type { Quaternion, Vec3 } from '../../../model/pose';

export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** a + k b. */
export const plus = (a: Vec3, b: Vec3, k = 1): Vec3 => [
  a[0] + k * b[0],
  a[1] + k * b[1],
  a[2] + k * b[2],
];

export const minus = (a: Vec3, b: Vec3): Vec3 => plus(a, b, -1);

export const opposite = (v: Vec3): Vec3 => [-v[0], -v[1], -v[2]];

export function unit(v: Vec3): Vec3 {
  const length = Math.hypot(...v) || 1;
  return [v[0] / length, v[1] / length, v[2] / length];
}

/** Rounds, and turns -0 into 0. */
export const rounded = (value: number, digits: number): number => Number(value.toFixed(digits)) + 0;

export const roundedVector = (v: Vec3, digits: number): Vec3 => [
  rounded(v[0], digits),
  rounded(v[1], digits),
  rounded(v[2], digits),
];

export const inverse = ([w, x, y, z]: Quaternion): Quaternion => [w, -x, -y, -z];

/** The smallest rotation that turns the direction `from` into the direction `to`; both have length 1. */
export function rotationBetween(from: Vec3, to: Vec3): Quaternion {
  const cosine = dot(from, to);
  // For opposite directions, half a turn about any axis at right angles.
  if (cosine < -1 + 1e-9) {
    const axis = unit(cross(from, Math.abs(from[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    return [0, ...axis];
  }
  const [x, y, z] = cross(from, to);
  const length = Math.hypot(1 + cosine, x, y, z);
  return [(1 + cosine) / length, x / length, y / length, z / length];
}
