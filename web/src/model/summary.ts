import type { Warning } from './report';

/** A file that the colours of a model come from. */
export interface Companion {
  name: string;
  is_missing?: boolean;
}

/** The parts of the API's ModelSummary that the page reads, in the extras of a model. False and empty fields are absent. */
export interface Summary {
  format: string;
  scale: number;
  lowest_mm: number[];
  highest_mm: number[];
  has_texture_coordinates?: boolean;
  has_colour?: boolean;
  companions?: Companion[];
  triangles: number;
  shown_triangles: number;
  warnings?: Warning[];
}
