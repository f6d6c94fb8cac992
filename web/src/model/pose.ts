/**
 * The pose of the object on the page: its rotation, and the position of its bounding box's centre over the film. toApi
 * converts it to the API's X_FO, whose translation moves the box's centre to that position. The page does not choose z:
 * the object starts with its lowest point on the water.
 */
export type Vec3 = readonly [number, number, number];
/** w, x, y, z; a unit quaternion. */
export type Quaternion = readonly [number, number, number, number];

export interface Pose {
  rotation: Quaternion;
  /** Position of the centre of the object's bounding box over the film, mm; x to the right, y up. */
  centre_mm: readonly [number, number];
}

export const kUpright: Pose = { rotation: [1, 0, 0, 0], centre_mm: [0, 0] };

export function normalized(q: Quaternion): Quaternion {
  const length = Math.hypot(...q);
  if (length === 0) return [1, 0, 0, 0];
  return [q[0] / length, q[1] / length, q[2] / length, q[3] / length];
}

/** Applies b first, then a. */
export function product(a: Quaternion, b: Quaternion): Quaternion {
  const [aw, ax, ay, az] = a;
  const [bw, bx, by, bz] = b;
  return [
    aw * bw - ax * bx - ay * by - az * bz,
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
  ];
}

export function rotate(q: Quaternion, v: Vec3): Vec3 {
  const [w, x, y, z] = q;
  const t: Vec3 = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [
    v[0] + w * t[0] + y * t[2] - z * t[1],
    v[1] + w * t[1] + z * t[0] - x * t[2],
    v[2] + w * t[2] + x * t[1] - y * t[0],
  ];
}

/** A rotation about one of the film's axes, in degrees. */
export function turn(axis: 'x' | 'y' | 'z', degrees: number): Quaternion {
  const half = (degrees * Math.PI) / 360;
  const s = Math.sin(half);
  return [Math.cos(half), axis === 'x' ? s : 0, axis === 'y' ? s : 0, axis === 'z' ? s : 0];
}

/** Rotations about the film's x, then y, then z axis, in degrees, as typed by the user. */
export function fromAngles([x, y, z]: Vec3): Quaternion {
  return product(turn('z', z), product(turn('y', y), turn('x', x)));
}

/** Inverse of fromAngles; y within ±90, x and z within ±180. */
export function toAngles(q: Quaternion): Vec3 {
  const [w, x, y, z] = normalized(q);
  const degrees = (rad: number) => (rad * 180) / Math.PI;
  const sinY = Math.max(-1, Math.min(1, 2 * (w * y - z * x)));
  if (Math.abs(sinY) > 1 - 1e-12) {
    // Gimbal lock: x and z rotate about the same axis, so the whole angle is assigned to x.
    return [degrees(2 * Math.atan2(x, w)), degrees(Math.asin(sinY)), 0];
  }
  return [
    degrees(Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))),
    degrees(Math.asin(sinY)),
    degrees(Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))),
  ];
}

/** Converts to the API's pose. `box_mm` is the centre of the scaled object's bounding box in its own frame. */
export function toApi(
  pose: Pose,
  box_mm: Vec3,
): { rotationWxyz: number[]; translationMm: number[] } {
  const q = normalized(pose.rotation);
  const [x, y, z] = rotate(q, box_mm);
  return {
    rotationWxyz: [...q],
    translationMm: [pose.centre_mm[0] - x, pose.centre_mm[1] - y, -z],
  };
}

/** Inverse of toApi; undefined if the pose is incomplete. */
export function fromApi(
  pose: { rotationWxyz?: number[]; translationMm?: number[] } | undefined,
  box_mm: Vec3,
): Pose | undefined {
  const [w, qx, qy, qz] = pose?.rotationWxyz ?? [];
  const [tx, ty] = pose?.translationMm ?? [];
  if (w === undefined || qx === undefined || qy === undefined || qz === undefined) return undefined;
  if (tx === undefined || ty === undefined) return undefined;
  const q = normalized([w, qx, qy, qz]);
  const [x, y] = rotate(q, box_mm);
  return { rotation: q, centre_mm: [x + tx, y + ty] };
}
