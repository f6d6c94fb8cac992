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
  /** What the worker found wrong with each triangle, as bits. Empty in results of older builds. */
  flags: Uint8Array;
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
  const flags = Uint8Array.from(elements.get('face')?.columns.get('flags') ?? []);
  return { positions, indices, film_mm, contact_s, stretch, error_mm, flags, box, contactMax_s };
}

/** Bits of `flags` by the code of the warning that they belong to. */
const kFlags: Readonly<Record<string, number>> = {
  FILM_TORN: 1,
  FILM_WRINKLED: 2,
  THETA_CLAMPED: 4,
  PARTS_NOT_REACHED: 8,
  FILM_EDGE_REACHED: 8,
  AIR_TRAPPED: 16,
};

/** Returns the indices of the triangles that a warning is about; empty if it is not about parts of the surface. */
export function placesOf(code: string, map: SurfaceMap): number[] {
  const out: number[] = [];
  map.flags.forEach((flags, face) => {
    if (flags & (kFlags[code] ?? 0)) out.push(face);
  });
  return out;
}
