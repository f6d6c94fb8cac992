/** A layer of paint: how a picture or a colour comes to the surface. PaintLayer in spec.proto defines the fields. */
import type { components } from '../api/schema';
import type { Vec3 } from '../model/pose';

export type ProjectionName =
  | 'uv'
  | 'vertex_colors'
  | 'planar'
  | 'dip'
  | 'cylindrical'
  | 'box'
  | 'decal';

/** The choices for a layer. Fields that are not set have the defaults of the API. Frame O. */
export interface PaintLayer {
  projection: ProjectionName;
  /** Where the picture's middle is. */
  position_mm?: Vec3 | undefined;
  /** Direction of view, of any length. */
  direction?: Vec3 | undefined;
  /** The picture's upward direction, of any length; for 'dip' in frame F. */
  up?: Vec3 | undefined;
  /** Width of the picture on the object. */
  size_mm?: number | undefined;
  depth_mm?: number | undefined;
  /** Counter-clockwise, as seen by the viewer of the picture. */
  turn_deg?: number | undefined;
  mirror?: boolean | undefined;
  repeat?: boolean | undefined;
  /** 0 to 1. */
  opacity?: number | undefined;
  blend_mm?: number | undefined;
}

/** A layer as the API has it. */
export type LayerSpec = components['schemas']['PaintLayerInput'];

const vector = (v: readonly number[] | undefined): Vec3 | undefined =>
  v?.length === 3 ? [v[0]!, v[1]!, v[2]!] : undefined;

/** Removes the fields that are not set. */
function set<T extends object>(fields: T): { [K in keyof T]?: Exclude<T[K], undefined> } {
  const some = Object.entries(fields).filter(([, value]) => value !== undefined);
  return Object.fromEntries(some) as { [K in keyof T]?: Exclude<T[K], undefined> };
}

/** The fields of a layer in a spec, without its name and picture. Values that are not set are left out. */
export const layerSpec = (layer: PaintLayer): LayerSpec =>
  set({
    projection: layer.projection,
    positionMm: layer.position_mm && [...layer.position_mm],
    direction: layer.direction && [...layer.direction],
    up: layer.up && [...layer.up],
    sizeMm: layer.size_mm,
    depthMm: layer.depth_mm,
    turnDeg: layer.turn_deg,
    mirror: layer.mirror || undefined,
    repeat: layer.repeat,
    opacity: layer.opacity,
    blendMm: layer.blend_mm,
  });

/**
 * Inverse of layerSpec. `usual` is the projection of a layer that names none: 'uv' for meshes with texture coordinates,
 * otherwise 'dip'.
 */
export function layerOf(spec: LayerSpec, usual: ProjectionName): PaintLayer {
  const projection = (spec.projection || usual) as ProjectionName;
  const rest = {
    position_mm: vector(spec.positionMm),
    direction: vector(spec.direction),
    up: vector(spec.up),
    size_mm: spec.sizeMm,
    depth_mm: spec.depthMm,
    turn_deg: spec.turnDeg,
    mirror: spec.mirror || undefined,
    repeat: spec.repeat,
    opacity: spec.opacity,
    blend_mm: spec.blendMm,
  };
  return { projection, ...set(rest) };
}
