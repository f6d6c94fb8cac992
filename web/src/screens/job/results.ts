/** Results of a finished job, fetched on first use. */
import { signal } from '@preact/signals';
import { fetchBytes } from '../../api/call';
import { artifactPath, jobs as api } from '../../api/services';
import type { Artifact, JobReport, Warning } from '../../api/types';
import { filmOf, type Film } from '../../model/film';
import { done, refused, type Failure, type Result } from '../../model/result';
import type { SurfaceMap } from '../../model/surface_map';
import { readMap } from '../../worker/reader';

export const fileOf = (artifact: Artifact): string => artifact.name.split('/').at(-1)!;

/** A film image with the size of its pixels. */
export interface FilmImage {
  picture: ImageBitmap;
  pitch_mm: number;
}

export class Results {
  readonly artifacts = signal<Artifact[] | undefined>(undefined);
  readonly report = signal<JobReport | undefined>(undefined);
  readonly map = signal<SurfaceMap | undefined>(undefined);
  readonly film = signal<FilmImage | undefined>(undefined);
  readonly failure = signal<Failure | undefined>(undefined);
  private readonly begun = new Set<string>();

  constructor(readonly job: string) {}

  has(file: string): boolean {
    return this.artifacts.value?.some((artifact) => fileOf(artifact) === file) ?? false;
  }

  get warnings(): Warning[] {
    return Object.values(this.report.value ?? {})[0]?.run?.warnings ?? [];
  }

  /** The dip of a simulation. */
  get dip() {
    return this.report.value?.simulate?.parameters?.dip;
  }

  loadReport(): void {
    this.once('report', async () => {
      const list = await api.artifacts(this.job);
      if (!list.ok) return list;
      this.artifacts.value = list.value.artifacts;
      if (!this.has('report.json')) return done(undefined);
      const report = await api.report(this.job);
      if (report.ok) this.report.value = report.value;
      return report;
    });
  }

  loadMap(): void {
    this.once('map', async () => {
      const bytes = await fetchBytes(artifactPath(this.job, 'surface_map.ply'));
      if (!bytes.ok) return bytes;
      const map = await readMap(bytes.value);
      if (map.ok) this.map.value = map.value;
      return map;
    });
  }

  loadFilm(): void {
    this.once('film', async () => {
      const bytes = await fetchBytes(artifactPath(this.job, 'film.png'));
      if (!bytes.ok) return bytes;
      const picture = await createImageBitmap(new Blob([bytes.value], { type: 'image/png' })).catch(
        () => undefined,
      );
      if (!picture)
        return refused('this browser cannot show the film image', 'Download film.png under Files');
      const dpi = this.report.value?.simulate?.parameters?.dpi ?? 300;
      this.film.value = { picture, pitch_mm: 25.4 / dpi };
      return done(undefined);
    });
  }

  /** The film named in the report; for a polygon, its bounding box. */
  filmShape(): Film | undefined {
    const film = this.dip?.film;
    if (!film) return undefined;
    const [x0 = 0, y0 = 0] = film.minMm;
    const [x1 = 0, y1 = 0] = film.maxMm;
    return filmOf(film.name) ?? { name: film.name, width_mm: x1 - x0, height_mm: y1 - y0 };
  }

  private once(what: string, load: () => Promise<Result<unknown>>): void {
    if (this.begun.has(what)) return;
    this.begun.add(what);
    void load().then((result) => {
      if (result.ok) return;
      this.failure.value = result.failure;
      // After a lost connection, the next use tries again.
      if (result.failure.status === 0) this.begun.delete(what);
    });
  }
}
