/** Projection of the texture onto the object. PaintLayer in spec.proto defines it; the worker computes it. */
import { rotate, type Quaternion, type Vec3 } from './pose';

export type ProjectionKind = 'uv' | 'planar' | 'dip' | 'cylindrical' | 'box' | 'decal';

/** The user's choices. The worker has a default for each: a fitted picture along the dip, if there are no UVs. */
export interface Projection {
  kind?: ProjectionKind | undefined;
  /** Width of the picture on the object. */
  size_mm?: number | undefined;
  /** Counter-clockwise, as seen by the viewer of the picture. */
  turn_deg?: number | undefined;
}

/** The projection's fields of a simulation's spec. */
export const projectionSpec = ({ kind, size_mm, turn_deg }: Projection) => ({
  ...(kind ? { project: kind } : {}),
  ...(size_mm ? { projectSizeMm: size_mm } : {}),
  ...(turn_deg ? { projectTurnDeg: turn_deg } : {}),
});

/** Inverse of projectionSpec. */
export const projectionOf = (spec: {
  project?: string;
  projectSizeMm?: number;
  projectTurnDeg?: number;
}): Projection => ({
  ...(spec.project ? { kind: spec.project as ProjectionKind } : {}),
  ...(spec.projectSizeMm ? { size_mm: spec.projectSizeMm } : {}),
  ...(spec.projectTurnDeg ? { turn_deg: spec.projectTurnDeg } : {}),
});

/** A picture seen from below: along z of the film's frame ("dip"), or of the object's own frame ("planar"). */
export interface FlatPicture {
  kind: 'dip' | 'planar';
  /** Width of the picture, in units of the mesh; undefined: fitted. */
  width?: number | undefined;
  turn_deg: number;
  /** Width divided by height. */
  aspect: number;
}

/** True if both rotations place the picture equally. */
export const isSamePlace = (picture: FlatPicture, a: Quaternion, b: Quaternion): boolean =>
  picture.kind === 'planar' || a.every((value, i) => value === b[i]);

/**
 * Writes u, v of each vertex, with v pointing up. A fitted picture has the larger side of the bounding box as its
 * shorter side, and its middle is in the middle of the bounding box.
 */
export function projectPicture(
  mesh: { positions: Float32Array; indices: Uint32Array },
  rotation: Quaternion,
  picture: FlatPicture,
  uvs: Float32Array,
): void {
  const { right, up } = axesOf(rotation, picture.kind);
  const { positions } = mesh;
  for (let i = 0; i < positions.length; i += 3) {
    const [x, y, z] = [positions[i]!, positions[i + 1]!, positions[i + 2]!];
    uvs[(2 * i) / 3] = right[0] * x + right[1] * y + right[2] * z;
    uvs[(2 * i) / 3 + 1] = up[0] * x + up[1] * y + up[2] * z;
  }
  const { middle, longest } = extentOf(mesh.indices, uvs);
  const width = picture.width ?? longest * Math.max(1, picture.aspect);
  const height = width / picture.aspect;
  const angle = (picture.turn_deg * Math.PI) / 180;
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  for (let i = 0; i < uvs.length; i += 2) {
    const [s, t] = [uvs[i]! - middle[0], uvs[i + 1]! - middle[1]];
    uvs[i] = 0.5 + (cos * s + sin * t) / width;
    uvs[i + 1] = 0.5 + (cos * t - sin * s) / height;
  }
}

/** The picture's right and up in the frame of the mesh: -x and y, because somebody below sees it. */
function axesOf(rotation: Quaternion, kind: FlatPicture['kind']): { right: Vec3; up: Vec3 } {
  const [w, x, y, z] = rotation;
  const back: Quaternion = kind === 'planar' ? [1, 0, 0, 0] : [w, -x, -y, -z];
  return { right: rotate(back, [-1, 0, 0]), up: rotate(back, [0, 1, 0]) };
}

/** The middle and the larger side of the box around the points that triangles have. */
function extentOf(indices: Uint32Array, points: Float32Array) {
  let [left, right, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const index of indices) {
    const [s, t] = [points[2 * index]!, points[2 * index + 1]!];
    if (s < left) left = s;
    if (s > right) right = s;
    if (t < bottom) bottom = t;
    if (t > top) top = t;
  }
  return {
    middle: [(left + right) / 2, (bottom + top) / 2] as const,
    longest: Math.max(right - left, top - bottom) || 1,
  };
}
