/** Moves, scales and turns a picture on the object. Pure mathematics; PaintLayer in spec.proto has the formulas. */
import { rotate, type Quaternion, type Vec3 } from '../../../model/pose';
import type { PaintLayer } from '../../../paint/layer';
import type { Placement } from '../../../paint/placement';
import type { SurfacePoint } from '../../../view3d/pose_view';
import type { LayerChoices } from './choices';
import { sight, uprightFor } from './directions';
import {
  cross,
  dot,
  minus,
  opposite,
  plus,
  rotationBetween,
  rounded,
  roundedVector,
  unit,
} from './vectors';

/** The layer when it was touched, and the point of the surface that was touched. */
export interface Grip {
  layer: PaintLayer;
  placement: Placement;
  rotation_FO: Quaternion;
  at: SurfacePoint;
}

export const kLeastSize_mm = 0.1; // the API allows any size above 0
const kLargestSize_mm = 1e6;
const kDigits = 2; // of positions, mm
const kDegrees = 180 / Math.PI;

const place = (position_mm: Vec3): Vec3 => roundedVector(position_mm, kDigits);

/** The angle in (-180, 180], to a tenth of a degree. */
export const roundedTurn = (degrees: number): number => {
  const turn = rounded(degrees - 360 * Math.round(degrees / 360), 1);
  return turn === -180 ? 180 : turn;
};

/** The part of the layer that changes when the touched point of the picture is moved to another point. */
export function moved(grip: Grip, to: SurfacePoint): LayerChoices {
  switch (grip.layer.projection) {
    case 'cylindrical':
      return movedAround(grip, to);
    case 'decal':
      return movedDecal(grip, to);
    case 'box':
      return { position_mm: place(plus(grip.placement.position_mm, way(grip, to))) };
    default:
      return movedFlat(grip, to);
  }
}

const way = (grip: Grip, to: SurfacePoint): Vec3 => minus(to.point_mm, grip.at.point_mm);

/** Moves the picture in its plane. */
function movedFlat(grip: Grip, to: SurfacePoint): LayerChoices {
  const { direction, position_mm } = grip.placement;
  const along = way(grip, to);
  const inPlane = plus(along, direction, -dot(along, direction));
  return { position_mm: place(plus(position_mm, inPlane)) };
}

/** Turns the picture around the axis, and moves it along the axis. */
function movedAround(grip: Grip, to: SurfacePoint): LayerChoices {
  const { placement, layer, at } = grip;
  const turn = angleAround(placement, to.point_mm) - angleAround(placement, at.point_mm);
  const shift = dot(way(grip, to), placement.up);
  const { position_mm } = placement;
  return {
    turn_deg: roundedTurn((layer.turn_deg ?? 0) + turn * kDegrees),
    ...(Math.abs(shift) < 1e-9
      ? {}
      : { position_mm: place(plus(position_mm, placement.up, shift)) }),
  };
}

function angleAround({ position_mm, right, direction }: Placement, p: Vec3): number {
  const q = minus(p, position_mm);
  return Math.atan2(dot(q, right), -dot(q, direction));
}

/**
 * Lets a decal follow the surface: it looks against the normal, and keeps its upward direction. A decal that was touched
 * beside its picture comes to the pointer.
 */
function movedDecal(grip: Grip, to: SurfacePoint): LayerChoices {
  const { layer, placement, at } = grip;
  const isInside = isOnPicture(placement, at.point_mm);
  const turn = rotationBetween(unit(at.normal), unit(to.normal));
  const direction = isInside ? rotate(turn, placement.direction) : opposite(unit(to.normal));
  const up = upFor(grip, direction);
  // A fitted size would change with the direction.
  const size_mm = layer.size_mm ?? rounded(placement.width_mm, 3);
  const kept = { size_mm, ...chosen(direction, up) };
  if (!isInside) return { position_mm: place(to.point_mm), ...kept };
  const [s, t, depth] = inAxes(placement, minus(at.point_mm, placement.position_mm));
  const newUp = unit(plus(up, direction, -dot(up, direction)));
  const right = cross(direction, newUp);
  const offset = plus(plus(plus([0, 0, 0], right, s), newUp, t), direction, depth);
  return { position_mm: place(minus(to.point_mm, offset)), ...kept };
}

/** The direction, and the upward direction or undefined for the default. */
function chosen(direction: Vec3, up: Vec3): LayerChoices {
  return { up: undefined, ...sight(direction, up) };
}

const inAxes = ({ right, up, direction }: Placement, q: Vec3): Vec3 => [
  dot(q, right),
  dot(q, up),
  dot(q, direction),
];

/** True if the point is on the picture of a decal. */
function isOnPicture(placement: Placement, p: Vec3): boolean {
  const [s, t] = inAxes(placement, minus(p, placement.position_mm));
  const [cos, sin] = [Math.cos(placement.turn_rad), Math.sin(placement.turn_rad)];
  const across = Math.abs(cos * s + sin * t);
  const along = Math.abs(cos * t - sin * s);
  return across <= placement.width_mm / 2 && along <= placement.height_mm / 2;
}

const kLeastAngle = Math.cos((20 * Math.PI) / 180);
const kSteep = Math.cos((30 * Math.PI) / 180);

/** The upward direction that the decal has, or one that is upright in the view where that one is nearly along `direction`. */
function upFor({ layer, placement, rotation_FO }: Grip, direction: Vec3): Vec3 {
  // Near the poles, the default direction changes quickly.
  const isSteep = Math.abs(placement.direction[2]) > kSteep;
  const kept = layer.up ?? (isSteep ? placement.up : [0, 0, 1]);
  const isAlong = Math.abs(dot(unit(kept), direction)) > kLeastAngle;
  return isAlong ? uprightFor(direction, rotation_FO) : kept;
}

/** The width of the picture after scaling. */
export const scaled = (
  layer: PaintLayer,
  placement: Pick<Placement, 'width_mm'>,
  factor: number,
): LayerChoices => {
  const size = (layer.size_mm ?? placement.width_mm) * factor;
  return { size_mm: rounded(Math.min(kLargestSize_mm, Math.max(kLeastSize_mm, size)), 3) };
};

/** Turns the picture about its middle, so that the touched point comes into the direction of another point. */
export function turned(grip: Grip, to: SurfacePoint): LayerChoices {
  if (grip.layer.projection === 'cylindrical') return { turn_deg: movedAround(grip, to).turn_deg };
  const plane = planeAt(grip);
  const angle = (p: Vec3) => {
    const q = minus(p, grip.placement.position_mm);
    return Math.atan2(dot(q, plane.up), dot(q, plane.right));
  };
  const turn = angle(to.point_mm) - angle(grip.at.point_mm);
  return { turn_deg: roundedTurn((grip.layer.turn_deg ?? 0) + turn * kDegrees) };
}

/**
 * Turns the picture with two fingers.
 * @param degrees  counter-clockwise on the screen
 */
export function twisted(grip: Grip, degrees: number): LayerChoices {
  if (grip.layer.projection === 'cylindrical') return {};
  const isFromFront = dot(grip.at.normal, planeAt(grip).direction) < 0;
  const turn = isFromFront ? degrees : -degrees;
  return { turn_deg: roundedTurn((grip.layer.turn_deg ?? 0) + turn) };
}

/** The right, the up and the direction of view of the picture where it was touched; they differ only for 'box'. */
function planeAt({ layer, placement, at }: Grip): { right: Vec3; up: Vec3; direction: Vec3 } {
  const { right, up, direction } = placement;
  if (layer.projection !== 'box') return { right, up, direction };
  const [r, u, d] = inAxes(placement, at.normal).map(Math.abs) as [number, number, number];
  if (r > u && r > d) return { right: direction, up, direction: opposite(right) };
  if (u > r && u > d) return { right, up: direction, direction: opposite(up) };
  return { right, up, direction };
}
