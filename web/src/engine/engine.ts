/**
 * What reads models and previews dips for the page: at present the daemon (daemon.ts). Another implementation, such as one
 * in the browser itself, can stand beside it.
 */
import type { Preview, SimulateSpecInput, InspectSpec } from '../api/types';
import type { Result } from '../model/result';

/** A preview, and its map. */
export interface DipPreview extends Preview {
  /** For each place of the model that read() returns: film x and y (mm), contact time (s), stretch; NaN where no film arrives. */
  map: Float32Array;
}

export interface Engine {
  /** Reads a model as the computation understands it. Returns a binary glTF; see DisplayModel in the API. */
  read(model: InspectSpec, signal: AbortSignal): Promise<Result<ArrayBuffer>>;
  /** Previews a dip roughly. A new call ends the previous one. */
  preview(dip: SimulateSpecInput, signal: AbortSignal): Promise<Result<DipPreview>>;
}
