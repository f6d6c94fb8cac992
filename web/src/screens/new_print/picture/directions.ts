/** Directions from which a picture is projected, named as in the view: in frame F, over the film. */
import { rotate, type Quaternion, type Vec3 } from '../../../model/pose';
import { usualUp } from '../../../paint/placement';
import { dot, inverse, roundedVector, unit } from './vectors';

export const kSides = ['below', 'front', 'back', 'left', 'right', 'above'] as const;
export type Side = (typeof kSides)[number];

/** A direction of view with the picture's upward direction, in frame O unless stated otherwise. */
export interface Sight {
  direction: Vec3;
  up?: Vec3;
}

const kX: Vec3 = [1, 0, 0];
const kY: Vec3 = [0, 1, 0];
const kZ: Vec3 = [0, 0, 1];

const kDirections_F: Record<Side, Vec3> = {
  below: kZ,
  front: kY,
  back: [0, -1, 0],
  left: kX,
  right: [-1, 0, 0],
  above: [0, 0, -1],
};

// The API's default changes within one degree of the z axis. This page changes it earlier, so that a picture on a slope
// near the top of an object is upright as seen from the front.
const kSteep = Math.cos((30 * Math.PI) / 180);
const kDigits = 9;

/** True if both vectors have the same direction. */
export const isParallel = (a: Vec3, b: Vec3): boolean => dot(unit(a), unit(b)) > 1 - 1e-9;

/** Adds the upward direction, unless it is the default. */
export function sight(direction: Vec3, up: Vec3): Sight {
  const rounded = roundedVector(direction, kDigits);
  if (isParallel(up, usualUp(unit(direction)))) return { direction: rounded };
  return { direction: rounded, up: roundedVector(up, kDigits) };
}

/** The upward direction with which a picture is upright in the view. */
export function uprightFor(direction: Vec3, rotation_FO: Quaternion): Vec3 {
  const isSteep = Math.abs(rotate(rotation_FO, unit(direction))[2]) > kSteep;
  return rotate(inverse(rotation_FO), isSteep ? kY : kZ);
}

/** Looks from a side of the view at the object as it is turned now. */
export function lookFrom(side: Side, rotation_FO: Quaternion): Sight {
  const direction = rotate(inverse(rotation_FO), kDirections_F[side]);
  return sight(direction, uprightFor(direction, rotation_FO));
}

/** The side from which the picture is projected; undefined if it is another one. */
export function sideOf(direction: Vec3 | undefined, rotation_FO: Quaternion): Side | undefined {
  const seen = rotate(rotation_FO, direction ?? kZ);
  return kSides.find((side) => isParallel(seen, kDirections_F[side]));
}

export const kAxes = ['upright', 'sideways', 'forward'] as const;
export type Axis = (typeof kAxes)[number];

const kAxes_F: Record<Axis, { up: Vec3; direction: Vec3 }> = {
  upright: { up: kZ, direction: kY },
  sideways: { up: kX, direction: kY },
  forward: { up: kY, direction: kZ },
};

/** The axis of a cylindrical projection, and the direction of view at its front. */
export function around(axis: Axis, rotation_FO: Quaternion): { direction?: Vec3; up?: Vec3 } {
  const back = inverse(rotation_FO);
  const up = roundedVector(rotate(back, kAxes_F[axis].up), kDigits);
  const direction = roundedVector(rotate(back, kAxes_F[axis].direction), kDigits);
  if (isParallel(up, kZ) && isParallel(direction, kY)) return {};
  return { direction, up };
}

/** The axis around which the picture goes; undefined if it is another one. */
export function axisOf(
  { direction = kY, up }: { direction?: Vec3; up?: Vec3 },
  rotation_FO: Quaternion,
): Axis | undefined {
  const seen = unit(rotate(rotation_FO, up ?? usualUp(unit(direction))));
  return kAxes.find((axis) => Math.abs(dot(seen, kAxes_F[axis].up)) > 1 - 1e-9);
}
