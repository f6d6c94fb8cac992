import { Refusal } from './result';
import type { Vec3 } from './pose';

/** The displayed part of a material: its colour, and its image, either by name or embedded in the model's file. */
export interface SurfaceMaterial {
  colour: [number, number, number];
  map?: string;
  picture?: { bytes: Uint8Array; type: string };
}

/** A triangle mesh in the units and axes of its file. */
export interface Mesh {
  /** x, y, z of each vertex. */
  positions: Float32Array;
  /** Three vertices per triangle, counter-clockwise when seen from outside. */
  indices: Uint32Array;
  /** u, v of each vertex, with v pointing up; absent if the file has no texture coordinates. */
  uvs?: Float32Array;
  /** Red, green, blue of each vertex, 0 to 255; absent if the file has no vertex colours. */
  colours?: Uint8Array;
  /** Ranges of triangles that share a material; `first` and `count` refer to `indices`. */
  parts: { material: string; first: number; count: number }[];
  /** The material libraries that an OBJ references. */
  libraries: string[];
  /** Materials defined in the model's own file. */
  materials?: Map<string, SurfaceMaterial>;
  /** Length of one unit, if the file format defines it. */
  unit_mm?: number;
}

export interface Box {
  min: Vec3;
  max: Vec3;
}

/** Returns the bounding box. Throws a Refusal if there are no triangles or if a vertex is missing or not finite. */
export function boxOf(mesh: Mesh): Box {
  if (mesh.indices.length === 0)
    throw new Refusal(
      'the model has no faces',
      'Export the model as a mesh, not as points or curves',
    );
  const min: [number, number, number] = [Infinity, Infinity, Infinity];
  const max: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (const index of mesh.indices) {
    for (let axis = 0; axis < 3; axis += 1) {
      const value = mesh.positions[3 * index + axis];
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
