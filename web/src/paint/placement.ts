/** Where the picture of a layer is on the object, with all defaults filled in; same as placement.cpp of the worker. */
import { rotate, type Quaternion, type Vec3 } from '../model/pose';
import { Refusal } from '../model/result';
import type { PaintLayer, ProjectionName } from './layer';

/** The part of a mesh that placements depend on. */
export interface Solid {
  /** x, y, z of each vertex, in units of the mesh's file. */
  positions: Float32Array;
  indices: Uint32Array;
  /** Length of a unit, mm. Default: 1. */
  scale?: number | undefined;
}

/** Frame O, mm. */
export interface Placement {
  projection: ProjectionName;
  position_mm: Vec3;
  /** The picture's right (r) and up (u), and the direction of view (d); orthonormal. */
  right: Vec3;
  up: Vec3;
  direction: Vec3;
  /** Size of the picture on the object. */
  width_mm: number;
  height_mm: number;
  /** R of 'cylindrical'. */
  radius_mm: number;
  /** Depth of a decal; 0: unlimited. */
  depth_mm: number;
  /** Width over which the axes of 'box' blend. */
  blend_mm: number;
  turn_rad: number;
  mirror: boolean;
  repeat: boolean;
}

type Vector = [number, number, number];
interface Axes {
  right: Vec3;
  up: Vec3;
  direction: Vec3;
}

/** Cosine of one degree: the least angle between up and the direction of view. */
const kNearlyParallel = 0.9998477;
const kBlendPerSide = 0.1;
const kLeastSide_mm = 1e-6;

const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vec3, b: Vec3): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
const plus = (a: Vec3, b: Vec3, factor: number): Vector => [
  a[0] + factor * b[0],
  a[1] + factor * b[1],
  a[2] + factor * b[2],
];

function unit(v: Vec3, what: string): Vector {
  const length = Math.hypot(...v);
  if (!(length > 0)) throw new Refusal(`the ${what} has no length`, 'Choose another direction');
  return [v[0] / length, v[1] / length, v[2] / length];
}

/** The part of `v` at right angles to the unit vector `to`, with length 1. */
const across = (v: Vec3, to: Vec3): Vector => unit(plus(v, to, -dot(v, to)), 'direction');

const standsUpright = (projection: ProjectionName): boolean =>
  projection === 'cylindrical' || projection === 'box';

/** The direction of view of a layer without one. */
export const usualDirection = (projection: ProjectionName): Vec3 =>
  standsUpright(projection) ? [0, 1, 0] : [0, 0, 1];

/** The upward direction of a layer without one, which is seen along a unit vector. */
export const usualUp = (direction: Vec3): Vec3 =>
  Math.abs(direction[2]) >= kNearlyParallel ? [0, 1, 0] : [0, 0, 1];

function axesOf(layer: PaintLayer, rotation: Quaternion): Axes {
  const { projection } = layer;
  const inF = projection === 'dip';
  const usual = usualDirection(projection);
  let direction = unit(inF ? usual : (layer.direction ?? usual), 'direction of view');
  let up = unit(layer.up ?? usualUp(direction), 'up direction');
  if (!(Math.abs(dot(direction, up)) < kNearlyParallel))
    throw new Refusal(
      'the up direction is parallel to the direction of view',
      'Choose another up direction',
    );
  if (projection === 'cylindrical') direction = across(direction, up);
  else up = across(up, direction);
  const right = cross(direction, up);
  if (!inF) return { right, up, direction };
  const [w, x, y, z] = rotation;
  const toO = (v: Vec3) => rotate([w, -x, -y, -z], v);
  return { right: toO(right), up: toO(up), direction: toO(direction) };
}

/** A bounding box with the directions r, u and d: its sides, and its middle in frame O; mm. */
interface AxesBox {
  sides: Vec3;
  middle: Vec3;
}

// The last box of each mesh. While a picture is dragged, the axes often stay.
const lastBoxes = new WeakMap<Float32Array, { key: string; box: AxesBox }>();

function boxAlong(axes: Axes, solid: Solid): AxesBox {
  const key = JSON.stringify([axes, solid.scale]);
  const last = lastBoxes.get(solid.positions);
  if (last?.key === key) return last.box;
  const box = computeBox(axes, solid);
  lastBoxes.set(solid.positions, { key, box });
  return box;
}

function computeBox({ right, up, direction }: Axes, solid: Solid): AxesBox {
  const { positions, indices, scale = 1 } = solid;
  const [rx, ry, rz] = right;
  const [ux, uy, uz] = up;
  const [dx, dy, dz] = direction;
  let [r0, u0, d0] = [Infinity, Infinity, Infinity];
  let [r1, u1, d1] = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < indices.length; i += 1) {
    const at = 3 * indices[i]!;
    const x = positions[at]!;
    const y = positions[at + 1]!;
    const z = positions[at + 2]!;
    const r = rx * x + ry * y + rz * z;
    const u = ux * x + uy * y + uz * z;
    const d = dx * x + dy * y + dz * z;
    if (r < r0) r0 = r;
    if (r > r1) r1 = r;
    if (u < u0) u0 = u;
    if (u > u1) u1 = u;
    if (d < d0) d0 = d;
    if (d > d1) d1 = d;
  }
  const half = scale / 2;
  const middle = plus(
    plus(plus([0, 0, 0], right, half * (r0 + r1)), up, half * (u0 + u1)),
    direction,
    half * (d0 + d1),
  );
  return { sides: [scale * (r1 - r0), scale * (u1 - u0), scale * (d1 - d0)], middle };
}

/** The larger side of the box in the picture's plane. */
function sideOf(projection: ProjectionName, [r, u, d]: Vec3): number {
  if (projection === 'box') return Math.max(r, u, d);
  if (projection === 'cylindrical') return Math.max(r, d);
  return Math.max(r, u);
}

function usualWidth(projection: ProjectionName, side_mm: number, aspect: number): number {
  if (projection === 'cylindrical') return Math.PI * side_mm;
  const whole = projection === 'decal';
  return aspect > 1 === whole ? side_mm : side_mm * aspect;
}

/** The width with which a picture repeats a whole number of times around a cylinder. */
function wholeAround(width_mm: number, radius_mm: number): number {
  const around_mm = 2 * Math.PI * radius_mm;
  return around_mm / Math.max(1, Math.round(around_mm / width_mm));
}

/**
 * Places a layer on a mesh. Not for 'uv' and 'vertex_colors', whose result has no meaning. Throws a Refusal for
 * directions without length, or an up direction within one degree of the direction of view.
 * @param rotation  from frame O to frame F at the start of the dip
 * @param aspect    width of the picture divided by its height; 1 for a plain colour
 */
export function place(
  layer: PaintLayer,
  solid: Solid,
  rotation: Quaternion,
  aspect: number,
): Placement {
  const { projection } = layer;
  const axes = axesOf(layer, rotation);
  const { sides, middle } = boxAlong(axes, solid);
  const side_mm = Math.max(sideOf(projection, sides), kLeastSide_mm);
  const radius_mm = side_mm / 2;
  const repeat = layer.repeat ?? standsUpright(projection);
  const asked_mm = layer.size_mm ?? usualWidth(projection, side_mm, aspect);
  const isRound = projection === 'cylindrical' && repeat;
  const width_mm = isRound ? wholeAround(asked_mm, radius_mm) : asked_mm;
  return {
    projection,
    ...axes,
    position_mm: layer.position_mm ?? middle,
    width_mm,
    height_mm: width_mm / aspect,
    radius_mm,
    depth_mm: layer.depth_mm ?? 0,
    blend_mm: layer.blend_mm ?? kBlendPerSide * side_mm,
    turn_rad: ((layer.turn_deg ?? 0) * Math.PI) / 180,
    mirror: layer.mirror ?? false,
    repeat,
  };
}
