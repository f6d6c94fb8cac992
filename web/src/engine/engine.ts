/**
 * What reads models and previews dips for the page: at present the daemon (daemon.ts). Another implementation, such as one
 * in the browser itself, can stand beside it.
 */
import type { InspectSpec, ModelSummary, Preview, SimulateSpecInput } from '../api/types';
import type { Box, Mesh } from '../model/mesh';
import type { Result } from '../model/result';

/** Triangles between places, which previews map to the film. */
export interface Places {
  /** Frame O, mm: x, y, z of each place. */
  positions: Float32Array;
  /** Three places for each triangle. */
  corners: Uint32Array;
}

/** A model as the computation understands it. */
export interface Model {
  /** For display: thinned if it has many triangles. */
  mesh: Mesh;
  /** The bounding box of the whole model, in units of the file. */
  box: Box;
  places: Places;
  summary: ModelSummary;
}

/** A preview, and its map. */
export interface DipPreview extends Preview {
  /** For each place of the model that read() returns: film x and y (mm), contact time (s), stretch; NaN where no film arrives. */
  map: Float32Array;
}

export interface Engine {
  /** Reads a model. A new call, also of preview(), ends an unanswered one. */
  read(model: InspectSpec, signal: AbortSignal): Promise<Result<Model>>;
  /** Previews a dip roughly. A new call ends the previous one. */
  preview(dip: SimulateSpecInput, signal: AbortSignal): Promise<Result<DipPreview>>;
}
