/**
 * The quick simulation while an object is turned: stretch, coverage and warnings, well under a second after the last
 * change. All that the page knows of it is here; the API has none yet, and as long as `preview` is undefined nothing
 * of it is shown.
 */
import type { SurfaceMap } from '../../model/surface_map';
import type { Warning } from '../../model/report';
import type { Result } from '../../model/result';
import type { Draft } from './draft';

export interface Preview {
  map: SurfaceMap;
  /** Share of the surface that film reaches. */
  coverage: number;
  warnings: Warning[];
}

export type PreviewSource = (draft: Draft, signal: AbortSignal) => Promise<Result<Preview>>;

export const preview: PreviewSource | undefined = undefined;
