import { Refusal } from './result';
import type { Vec3 } from './pose';

/** What of a material is shown: its colour, and its picture, by name or as it lies in the model's own file. */
export interface Worn {
  colour: [number, number, number];
  map?: string;
  picture?: { bytes: Uint8Array; type: string };
}

/** A model as it stands in its file: triangles, in the file's own units and axes. */
export interface Mesh {
  /** x, y, z of each vertex. */
  positions: Float32Array;
  /** Three vertices each triangle, counter-clockwise from outside. */
  indices: Uint32Array;
  /** u, v of each vertex, v upwards; absent if the file has none. */
  uvs?: Float32Array;
  /** Red, green, blue of each vertex, 0 to 255; absent if the file has none. */
  colours?: Uint8Array;
  /** Runs of triangles that share a material; `first` and `count` in indices. */
  parts: { material: string; first: number; count: number }[];
  /** The material libraries that an OBJ names. */
  libraries: string[];
  /** Materials that the model's own file describes. */
  materials?: Map<string, Worn>;
  /** What one of its units is, where its format says so. */
  unit_mm?: number;
}

export interface Box {
  min: Vec3;
  max: Vec3;
}

/** The mesh's box; refuses one without triangles, or with a corner that is no number. */
export function boxOf(mesh: Mesh): Box {
  if (mesh.indices.length === 0)
    throw new Refusal('the model has no faces', 'Export the surface, not points or curves');
  const min: [number, number, number] = [Infinity, Infinity, Infinity];
  const max: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (const index of mesh.indices) {
    for (let axis = 0; axis < 3; axis += 1) {
      const value = mesh.positions[3 * index + axis];
      if (value === undefined || !Number.isFinite(value))
        throw new Refusal('a face names a corner that is not there', 'Export the model again');
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

export const longestOf = ({ min, max }: Box): number =>
  Math.max(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
