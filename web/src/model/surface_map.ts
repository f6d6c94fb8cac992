import { boxOf } from './mesh';
import { columnsOf, readPly, trianglesOf } from './ply';
import { Refusal } from './result';

/** Maps each point of the object to its point on the film (surface_map.ply). Frame O, mm, after scaling. */
export interface SurfaceMap {
  positions: Float32Array;
  indices: Uint32Array;
  /** x, y on the film at rest, mm; NaN where the film does not reach. */
  film_mm: Float32Array;
  /** Time at which the water reaches the point, s. */
  contact_s: Float32Array;
  /** Largest principal stretch; 1 at rest. */
  stretch: Float32Array;
  /** Stated error of the place on the film, mm; Infinity where no bound is known. Undefined in results of older builds. */
  error_mm: Float32Array | undefined;
  /** Bounding box, mm. */
  box: { min: readonly [number, number, number]; max: readonly [number, number, number] };
  contactMax_s: number;
}

export function readSurfaceMap(bytes: ArrayBuffer): SurfaceMap {
  const elements = readPly(bytes);
  const vertex = elements.get('vertex');
  const positions = vertex && columnsOf(vertex, ['x', 'y', 'z']);
  const film_mm = vertex && columnsOf(vertex, ['film_x', 'film_y']);
  const contact_s = vertex && columnsOf(vertex, ['contact_time']);
  const stretch = vertex && columnsOf(vertex, ['stretch']);
  if (!positions || !film_mm || !contact_s || !stretch)
    throw new Refusal(
      'the file is not a surface map: x, y, z, film_x, film_y, contact_time or stretch is missing',
      'Run the simulation again',
    );
  const indices = trianglesOf(elements);
  const box = boxOf({ positions, indices });
  let contactMax_s = 0;
  for (const t of contact_s) if (t > contactMax_s) contactMax_s = t;
  const error_mm = columnsOf(vertex, ['error_mm']);
  return { positions, indices, film_mm, contact_s, stretch, error_mm, box, contactMax_s };
}

/** Returns the indices of the triangles that a warning is about; empty if it is not about parts of the surface. */
export function placesOf(
  code: string,
  map: SurfaceMap,
  limits: { tear: number },
  up: UpOf,
): number[] {
  const isThere = testOf(code, map, limits, up);
  if (!isThere) return [];
  const out: number[] = [];
  for (let face = 0; face < map.indices.length / 3; face += 1) if (isThere(face)) out.push(face);
  return out;
}

/** Returns the z component of a direction of frame O after the object's rotation; 1 is straight up. */
export type UpOf = (direction: readonly [number, number, number]) => number;

function testOf(
  code: string,
  map: SurfaceMap,
  limits: { tear: number },
  up: UpOf,
): ((face: number) => boolean) | undefined {
  const corner = (face: number, i: number) => map.indices[3 * face + i]!;
  const any = (of: (vertex: number) => boolean) => (face: number) =>
    of(corner(face, 0)) || of(corner(face, 1)) || of(corner(face, 2));
  switch (code) {
    case 'parts_not_reached':
    case 'film_edge_reached':
    case 'air_trapped':
      return any((vertex) => Number.isNaN(map.stretch[vertex]));
    case 'film_torn':
      return any((vertex) => map.stretch[vertex]! > limits.tear);
    case 'stretch_beyond_stokes':
      return any((vertex) => map.stretch[vertex]! > 1.3);
    case 'theta_clamped':
      return (face) => up(normalOf(map, face)) > Math.cos((10 * Math.PI) / 180);
    default:
      return undefined;
  }
}

function normalOf(map: SurfaceMap, face: number): readonly [number, number, number] {
  const at = (i: number, axis: number) => map.positions[3 * map.indices[3 * face + i]! + axis]!;
  const a = [0, 1, 2].map((k) => at(1, k) - at(0, k));
  const b = [0, 1, 2].map((k) => at(2, k) - at(0, k));
  const n = [
    a[1]! * b[2]! - a[2]! * b[1]!,
    a[2]! * b[0]! - a[0]! * b[2]!,
    a[0]! * b[1]! - a[1]! * b[0]!,
  ] as const;
  const length = Math.hypot(...n) || 1;
  return [n[0] / length, n[1] / length, n[2] / length];
}
