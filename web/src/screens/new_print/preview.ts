/**
 * The preview: a quick simulation, repeated while the object is rotated. It shows coverage, stretch and warnings, for
 * usual models well under a second after the last change. All code for previews is in this file.
 */
import { computed, effect, signal } from '@preact/signals';
import type { SimulateSpecInput, Warning } from '../../api/types';
import { daemon } from '../../engine/daemon';
import type { DipPreview, Places } from '../../engine/engine';
import { dipsOf, type Dip } from '../../model/dips';
import { nameFor } from '../../model/files';
import { done, wordsOf, type Failure, type Result } from '../../model/result';
import { may } from '../../state/session';
import { markRefused } from '../../ui/field_errors';
import { calibrated } from './calibration';
import { centre_mm, draft, shape, simulateOf, type Draft, type Inputs, type Shape } from './draft';
import { profileOf, readAgain } from './intake';
import { bring, stage, whyWait } from './reading';

/** The displayed values of the last preview. */
export interface Shown {
  /** Frame O, mm. */
  positions: Float32Array;
  corners: Uint32Array;
  /** Stretch of each vertex; NaN where the film does not reach. */
  stretch: Float32Array;
  coverage: number;
  stretchP95: number;
  seconds: number;
  warnings: Warning[];
}

export const shown = signal<Shown | undefined>(undefined);
type Figures = Pick<Shown, 'coverage' | 'stretchP95'>;

/** Previews of dips that have the same `of`: everything in the spec but the pose and the depth. */
const seen = signal<{ of: string; figures: ReadonlyMap<string, Figures> }>({
  of: '',
  figures: new Map(),
});

const keyOf = ({ pose, depth_mm }: Dip): string => JSON.stringify([pose, depth_mm ?? null]);

/** The preview of a dip; undefined if there was none since something else changed. */
export const figuresOf = (dip: Dip): Figures | undefined => seen.value.figures.get(keyOf(dip));

function keepFigures(spec: SimulateSpecInput, dip: Dip, figures: Figures) {
  const { pose: _, depthMm: __, ...others } = spec;
  const of = JSON.stringify(others);
  const known = of === seen.value.of ? seen.value.figures : [];
  seen.value = { of, figures: new Map([...known, [keyOf(dip), figures]]) };
}

/** The reason why there is no preview, with its remedy; empty otherwise. */
export const trouble = signal('');
export const isComputing = signal(false);

const kPause_ms = 60;
const kWait_ms = 2000; // after a failure that ends by itself

type Settings = Omit<Draft, 'layer' | 'requestId' | 'before' | 'after'>;

const isSame = (a: Settings, b: Settings): boolean => {
  const fields = new Set([...Object.keys(a), ...Object.keys(b)]) as Set<keyof Settings>;
  return [...fields].every((field) => a[field] === b[field]);
};

let lastSettings: Settings | undefined;
/** The draft without the picture's layer and the other dips, which do not change a preview. */
const settings = computed(() => {
  const { layer: _, requestId: __, before: ___, after: ____, ...now } = draft.value;
  if (!lastSettings || !isSame(lastSettings, now)) lastSettings = now;
  return lastSettings;
});

/** Keeps the preview up to date until the returned function is called. */
export function followPreview(): () => void {
  const requester = new PreviewRequester();
  const end = effect(() => {
    void [settings.value, calibrated.value, shape.value];
    // A model that is read would end the preview.
    if (!stage.value) requester.schedule();
  });
  return () => {
    end();
    requester.end();
  };
}

class PreviewRequester {
  private asking = new AbortController();
  private timer = 0;
  /** True if the model was read again, and there was no preview since. */
  private hasReadAgain = false;
  /** The places of the last model that was read for its shape; `key` identifies it. */
  private known: { key: string; places: Places } | undefined;

  schedule(pause_ms = kPause_ms): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.ask(), pause_ms);
  }

  end(): void {
    this.asking.abort();
    window.clearTimeout(this.timer);
    shown.value = undefined;
    trouble.value = '';
    markRefused('preview');
  }

  private async ask(): Promise<void> {
    const now = shape.value;
    if (!now || !may('MAKER')) return;
    this.asking.abort();
    this.asking = new AbortController();
    const { signal: abortSignal } = this.asking;
    const dip = draft.value;
    isComputing.value = true;
    const computed = await this.compute(now, dip, abortSignal);
    if (abortSignal.aborted) return;
    isComputing.value = false;
    if (!computed.ok) return this.refuse(computed.failure);
    const { spec, places, preview } = computed.value;
    keepFigures(spec, dip, preview);
    this.show(preview, places);
    await this.askForOthers(spec, abortSignal);
  }

  private async compute(now: Shape, dip: Draft, abortSignal: AbortSignal) {
    const inputs = await inputsFor(now, abortSignal);
    if (!inputs.ok) return inputs;
    const spec = partOf(dip, inputs.value);
    const places = await this.places(now, spec, abortSignal);
    if (!places.ok) return places;
    const preview = await daemon.preview(spec, abortSignal);
    return preview.ok ? done({ spec, places: places.value, preview: preview.value }) : preview;
  }

  /** Previews the other dips of which there is no preview yet. */
  private async askForOthers(like: SimulateSpecInput, abortSignal: AbortSignal): Promise<void> {
    for (const dip of dipsOf(draft.value)) {
      if (figuresOf(dip)) continue;
      const { pose, depthMm } = simulateOf({ ...draft.value, ...dip }, kNoInputs, centre_mm.value);
      const { depthMm: _, ...others } = like;
      const spec = { ...others, pose: pose!, ...(depthMm ? { depthMm } : {}) };
      const answer = await daemon.preview(spec, abortSignal);
      if (abortSignal.aborted) return;
      if (answer.ok) keepFigures(spec, dip, answer.value);
    }
  }

  /** Returns the places of the spec's model. At another scale, thinning may have another result. */
  private async places(
    { places, source, summary }: Shape,
    { scale = 1 }: SimulateSpecInput,
    abortSignal: AbortSignal,
  ): Promise<Result<Places>> {
    if (scale === summary.scale) return done(places);
    const key = JSON.stringify([source, scale]);
    if (this.known?.key === key) return done(this.known.places);
    const read = await daemon.read({ ...source, scale, shapeOnly: true }, abortSignal);
    if (!read.ok) return read;
    this.known = { key, places: read.value.places };
    return done(read.value.places);
  }

  private refuse(failure: Failure): void {
    if (failure.reason === 'ASSET_MISSING' && !this.hasReadAgain) {
      this.hasReadAgain = true;
      return void readAgain();
    }
    markRefused('preview', failure.violations);
    const why = whyWait(failure);
    shown.value = undefined;
    trouble.value = why ?? wordsOf(failure);
    if (why) this.schedule(kWait_ms);
  }

  private show(preview: DipPreview, { positions, corners }: Places): void {
    const { map } = preview;
    this.hasReadAgain = false;
    trouble.value = '';
    markRefused('preview');
    shown.value = {
      positions,
      corners,
      stretch: Float32Array.from({ length: map.length / 4 }, (_, i) => map[4 * i + 3]!),
      coverage: preview.coverage,
      stretchP95: preview.stretchP95,
      seconds: preview.seconds,
      warnings: preview.warnings,
    };
  }
}

/** The files of the preview's spec: those from which the model was read, and the film's profile. */
async function inputsFor({ source }: Shape, signal: AbortSignal): Promise<Result<Inputs>> {
  const { from, files } = draft.value;
  const profile = profileOf(files);
  if (!profile) {
    const ofJob = from?.spec.profile as Inputs['profile'];
    return done(ofJob ? { ...source, profile: ofJob } : source);
  }
  const brought = await bring([{ name: nameFor(profile), file: profile }], () => {}, signal);
  return brought.ok ? done({ ...source, profile: brought.value[0]! }) : brought;
}

/** Dips are previewed without the picture, whose files this lacks. */
const kNoInputs: Inputs = { mesh: { name: '', asset: '' }, extraFiles: [] };

/** The part of a simulation's spec that affects its preview. */
function partOf(dip: Draft, { mesh, extraFiles, profile }: Inputs): SimulateSpecInput {
  const simulate = simulateOf(dip, kNoInputs, centre_mm.value);
  const calibration = calibrated.value?.calibration;
  const measured = calibration
    ? { pose: calibration.pose, scale: calibration.scale, film: calibration.film || undefined }
    : { pose: simulate.pose, scale: simulate.scale, film: simulate.film };
  const outline = calibration?.filmFile ? [calibration.filmFile] : [];
  return {
    mesh,
    extraFiles: [...extraFiles, ...outline],
    ...(profile ? { profile } : {}),
    ...(measured as Pick<SimulateSpecInput, 'pose' | 'scale' | 'film'>),
    ...(simulate.depthMm ? { depthMm: simulate.depthMm } : {}),
    ...(simulate.dipSpeedMmPerS ? { dipSpeedMmPerS: simulate.dipSpeedMmPerS } : {}),
  };
}
