/**
 * The preview: a quick simulation, repeated while the object is rotated. It shows coverage, stretch and warnings well
 * under a second after the last change. All code for previews is in this file. Before the first preview nothing is
 * shown, and a missing preview is not an error.
 */
import { computed, effect, signal } from '@preact/signals';
import type { SimulateSpecInput } from '../../api/types';
import { upload } from '../../api/uploads';
import { daemon } from '../../engine/daemon';
import type { DipPreview } from '../../engine/engine';
import { placesOf, type Places } from '../../engine/places';
import { dipsOf, type Dip } from '../../model/dips';
import type { Warning } from '../../model/report';
import { done, type Failure, type Result } from '../../model/result';
import { may } from '../../state/session';
import { calibrated } from './calibration';
import { centre_mm, draft, shape, simulateOf, type Draft, type Inputs } from './draft';
import { inputsOf } from './intake';

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

/** Why there is no preview, if the input is the reason (for example, the object is beside the film). */
export const refusal = signal('');
export const isComputing = signal(false);

const kPause_ms = 60;

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
  const inputs = computed(() => (shape.value ? inputsOf(draft.value.files) : []));
  const ends = [
    effect(() => {
      void draft.value.files;
      void requester.bring(inputs.value);
    }),
    effect(() => {
      void settings.value;
      void calibrated.value;
      requester.schedule();
    }),
  ];
  return () => {
    ends.forEach((end) => end());
    requester.end();
  };
}

class PreviewRequester {
  private mesh: Inputs | undefined;
  private files: readonly File[] = [];
  private bringing = new AbortController();
  private asking = new AbortController();
  private timer = 0;
  /** The places of the last model; `key` identifies its asset and its calibration or scale. */
  private known: { key: string; places: Places } | undefined;
  private isOff = false;

  /** Uploads the files that a preview needs. Submitting needs them too. */
  async bring(inputs: ReturnType<typeof inputsOf>): Promise<void> {
    const wanted = inputs.filter(
      ({ role, name }) => role === 'mesh' || role === 'profile' || /\.mtl$/i.test(name),
    );
    if (
      wanted.length === this.files.length &&
      wanted.every(({ file }, i) => file === this.files[i])
    )
      return;
    this.files = wanted.map(({ file }) => file);
    this.bringing.abort();
    this.bringing = new AbortController();
    const { signal: abortSignal } = this.bringing;
    this.mesh = undefined;
    shown.value = undefined;
    if (wanted.length === 0 || !may('MAKER')) return;
    const out: Partial<Inputs> & { extraFiles: Inputs['extraFiles'] } = { extraFiles: [] };
    for (const { role, name, file } of wanted) {
      const asset = await upload(file, () => {}, abortSignal);
      if (!asset.ok || abortSignal.aborted) return;
      const input = { name, asset: asset.value };
      if (role === 'mesh') out.mesh = input;
      else if (role === 'profile') out.profile = input;
      else out.extraFiles.push(input);
    }
    if (!out.mesh) return;
    this.mesh = { ...out, mesh: out.mesh };
    this.schedule();
  }

  schedule(): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.ask(), kPause_ms);
  }

  end(): void {
    this.bringing.abort();
    this.asking.abort();
    window.clearTimeout(this.timer);
    shown.value = undefined;
    refusal.value = '';
  }

  private inputs(): Inputs | undefined {
    const { from, files } = draft.value;
    if (this.mesh || files.length > 0 || !from) return this.mesh;
    return from.spec as Inputs;
  }

  private async ask(): Promise<void> {
    const inputs = this.inputs();
    if (this.isOff || !inputs?.mesh || !shape.value) return;
    this.asking.abort();
    this.asking = new AbortController();
    const { signal: abortSignal } = this.asking;
    const dip = draft.value;
    const simulate = simulateOf(draft.value, inputs, centre_mm.value);
    const key = `${inputs.mesh.asset} ${calibrated.value?.calibration.name ?? draft.value.scale}`;
    isComputing.value = true;
    const spec = partOf(simulate, inputs);
    const places = await this.places(spec, key, abortSignal);
    const answer = places.ok ? await daemon.preview(spec, abortSignal) : places;
    if (abortSignal.aborted) return;
    isComputing.value = false;
    if (!answer.ok) return this.refuse(answer.failure);
    if (!places.ok) return;
    keepFigures(spec, dip, answer.value);
    this.show(answer.value, places.value);
    await this.askForOthers(inputs, abortSignal);
  }

  /** Previews the other dips of which there is no preview yet. */
  private async askForOthers(inputs: Inputs, abortSignal: AbortSignal): Promise<void> {
    for (const dip of dipsOf(draft.value)) {
      if (figuresOf(dip)) continue;
      const spec = partOf(simulateOf({ ...draft.value, ...dip }, inputs, centre_mm.value), inputs);
      const answer = await daemon.preview(spec, abortSignal);
      if (abortSignal.aborted) return;
      if (answer.ok) keepFigures(spec, dip, answer.value);
    }
  }

  /** Returns the places of the spec's model, which is read again if it is another one. */
  private async places(
    { mesh, extraFiles, scale }: SimulateSpecInput,
    key: string,
    abortSignal: AbortSignal,
  ): Promise<Result<Places>> {
    if (this.known?.key === key) return done(this.known.places);
    const glb = await daemon.read(
      {
        mesh: mesh!,
        extraFiles: extraFiles ?? [],
        ...(scale ? { scale } : {}),
        shapeOnly: true,
      },
      abortSignal,
    );
    if (!glb.ok) return glb;
    const places = await placesOf(glb.value);
    if (places.ok && !abortSignal.aborted) this.known = { key, places: places.value };
    return places;
  }

  private refuse({ what, status, reason }: Failure): void {
    if (status === 404 || status === 501) this.isOff = true;
    shown.value = undefined;
    refusal.value = status === 400 || reason === 'PREVIEW_REFUSED' ? what : '';
  }

  private show(preview: DipPreview, { positions, corners }: Places): void {
    const { map } = preview;
    refusal.value = '';
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

/** The part of a simulation's spec that affects its preview. */
function partOf(simulate: SimulateSpecInput, inputs: Inputs): SimulateSpecInput {
  const calibration = calibrated.value?.calibration;
  const measured = calibration
    ? { pose: calibration.pose, scale: calibration.scale, film: calibration.film || undefined }
    : { pose: simulate.pose, scale: simulate.scale, film: simulate.film };
  const outline = calibration?.filmFile ? [calibration.filmFile] : [];
  return {
    mesh: inputs.mesh,
    extraFiles: [
      ...inputs.extraFiles.filter((file) => /\.(mtl|json)$/i.test(file.name)),
      ...outline,
    ],
    ...(inputs.profile ? { profile: inputs.profile } : {}),
    ...(measured as Pick<SimulateSpecInput, 'pose' | 'scale' | 'film'>),
    ...(simulate.depthMm ? { depthMm: simulate.depthMm } : {}),
    ...(simulate.dipSpeedMmPerS ? { dipSpeedMmPerS: simulate.dipSpeedMmPerS } : {}),
  };
}
