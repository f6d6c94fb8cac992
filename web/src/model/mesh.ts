import { Refusal } from './result';
import type { Vec3 } from './pose';

/** How a picture continues beyond its edges, along u and v. */
export type Wrap = 'repeat' | 'mirror' | 'clamp';

/** The own look of a part of a mesh. */
export interface Look {
  /** Red, green, blue in linear light, 0 to 1. It multiplies the picture and the colours of the vertices. */
  colour: readonly [number, number, number];
  /** Its first row is at the top. */
  picture?: ImageBitmap | undefined;
  wrap?: readonly [Wrap, Wrap];
}

/** A triangle mesh in the units and axes of its file. */
export interface Mesh {
  /** x, y, z of each vertex. */
  positions: Float32Array;
  /** Three vertices per triangle, counter-clockwise when seen from outside. */
  indices: Uint32Array;
  /** u, v of each vertex, with v pointing up; absent if the model has no texture coordinates. */
  uvs?: Float32Array;
  /** Red, green, blue of each vertex in linear light, 0 to 65535; absent if the model has no vertex colours. */
  colours?: Uint16Array;
  /** Ranges of triangles that share a look; `first` and `count` refer to `indices`. */
  parts: { look: Look; first: number; count: number }[];
}

export interface Box {
  min: Vec3;
  max: Vec3;
}

/** Returns the bounding box. Throws a Refusal if there are no triangles or if a vertex is missing or not finite. */
export function boxOf({ indices, positions }: Pick<Mesh, 'indices' | 'positions'>): Box {
  if (indices.length === 0)
    throw new Refusal(
      'the model has no faces',
      'Export the model as a mesh, not as points or curves',
    );
  const min: [number, number, number] = [Infinity, Infinity, Infinity];
  const max: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (const index of indices) {
    for (let axis = 0; axis < 3; axis += 1) {
      const value = positions[3 * index + axis];
      if (value === undefined || !Number.isFinite(value))
        throw new Refusal(
          'a face refers to a vertex that does not exist or is not finite',
          'Export the model again',
        );
      if (value < min[axis]!) min[axis] = value;
      if (value > max[axis]!) max[axis] = value;
    }
  }
  return { min, max };
}

export const centreOf = ({ min, max }: Box): Vec3 => [
  (min[0] + max[0]) / 2,
  (min[1] + max[1]) / 2,
  (min[2] + max[2]) / 2,
];

/** Extents along x, y and z. */
export const sidesOf = ({ min, max }: Box): Vec3 => [
  max[0] - min[0],
  max[1] - min[1],
  max[2] - min[2],
];

export const longestOf = (box: Box): number => Math.max(...sidesOf(box));
