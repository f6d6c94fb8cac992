/** The draft of a new print. It is kept with its files across reloads until the user starts over. */
import { batch, computed, effect, signal } from '@preact/signals';
import * as rules from '../../api/rules';
import { jobs as jobsApi, newRequestId } from '../../api/services';
import type {
  InputFile,
  Job,
  JobInput,
  PlanSpec,
  PlanSpecInput,
  SimulateSpec,
  SimulateSpecInput,
} from '../../api/types';
import { dipsOf, split, type Dips } from '../../model/dips';
import type { Model } from '../../engine/engine';
import { filmOf, type Film } from '../../model/film';
import { centreOf, longestOf, sidesOf } from '../../model/mesh';
import { fromApi, kUpright, toApi, type Vec3 } from '../../model/pose';
import { done, refused, type Failure, type Result } from '../../model/result';
import { load, save } from '../../state/store';
import { markRefused } from '../../ui/field_errors';
import { numberOf } from '../../ui/job_text';
import { enlarged, layerIn, type LayerChoices } from './picture/choices';
import { layerOfOldDraft, pictureOf, pictureSpec } from './picture/spec';

/** The user's choices, as plain values and files that IndexedDB can store. */
export interface Draft extends Dips {
  /** Dropped files; empty if the files of job `from` are used. */
  files: File[];
  /** The job that is run again with changes. */
  from?: Source;
  name: string;
  scale: number;
  /** How the picture comes to the surface, as far as it was chosen. */
  layer: LayerChoices;
  /** The calibration ("calibrations/7") whose pose is used instead of `pose`; empty for none. */
  calibration: string;
  film: string;
  dpi: number;
  paper: string;
  colours: 'COLOURS_RGB' | 'COLOURS_CMYK';
  model: 'MODEL_SHEET' | 'MODEL_STOKES';
  speed_mm_per_s: number;
  /** Ensures that a repeated request creates only one job. Every change of the draft sets a new id. */
  requestId: string;
}

/** A simulation, or a plan with what it has in common with one. */
interface Source {
  job: string;
  spec: SimulateSpec;
  plan?: Pick<PlanSpec, 'immersions' | 'blendMm'>;
  /** True once the draft has the dips of the job, which may have been changed since. */
  isTaken?: boolean;
}

export const kEmpty: Draft = {
  files: [],
  name: '',
  scale: rules.SimulateSpec.scale.usual,
  pose: kUpright,
  before: [],
  after: [],
  layer: {},
  calibration: '',
  film: rules.SimulateSpec.film.usual,
  dpi: rules.SimulateSpec.dpi.usual,
  paper: rules.PrintImageSpec.paper.usual,
  colours: rules.PrintImageSpec.colours.usual,
  model: rules.SimulateSpec.model.usual,
  speed_mm_per_s: rules.SimulateSpec.dipSpeedMmPerS.usual,
  requestId: '',
};

/** The model as it was read. */
export interface Shape extends Model {
  /** The uploaded files from which it was read. */
  source: { mesh: InputFile; extraFiles: InputFile[] };
  /** Why the model's own colours cannot be read. Its shape can. */
  colourless?: Failure;
}

export const draft = signal<Draft>(kEmpty);
export const shape = signal<Shape | undefined>(undefined);

export const change = (part: Partial<Draft>): void => {
  draft.value = { ...draft.value, requestId: newRequestId(), ...part };
};

/** The dip that is being changed, counted from 0; undefined if it is the only one. */
export const selectedDip = (): number | undefined =>
  dipsOf(draft.value).length > 1 ? draft.value.before.length : undefined;

/** Changes the scale. The picture keeps its place on the object. */
export const rescale = (scale: number): void =>
  change({ scale, layer: enlarged(draft.value.layer, scale / draft.value.scale) });

// Separate from the draft, so that other changes of the draft keep the film, and with it the view of the object.
const filmName = computed(() => draft.value.film);
export const film = computed<Film>(() => filmOf(filmName.value) ?? filmOf('A4')!);

/** Centre of the object's bounding box in its own frame, mm. */
export const centre_mm = computed<Vec3>(() => {
  const { scale } = draft.value;
  const [x, y, z] = shape.value ? centreOf(shape.value.box) : [0, 0, 0];
  return [x * scale, y * scale, z * scale];
});

/** Width, depth and height of the object's bounding box before it is turned, mm. */
export const sides_mm = computed<Vec3>(() => {
  const { scale } = draft.value;
  const [x, y, z] = shape.value ? sidesOf(shape.value.box) : [0, 0, 0];
  return [x * scale, y * scale, z * scale];
});

/** True if the model has no texture coordinates. */
export const lacksCoordinates = computed(
  () => shape.value !== undefined && !shape.value.summary.hasTextureCoordinates,
);

/** The picture's layer. Changes of other parts of the draft keep it. */
const choices = computed(() => draft.value.layer);
export const layer = computed(() => layerIn(choices.value, lacksCoordinates.value));

/** Longest side of the object's bounding box, mm. */
export const longest_mm = computed(() =>
  shape.value ? longestOf(shape.value.box) * draft.value.scale : 0,
);

const kDraftKey = 'new-print';

/** Restores the stored draft, then stores every change. Fields that were changed before it was read stay changed. */
export async function restore(): Promise<void> {
  const kept = await load<Draft & OldDraft>(kDraftKey);
  const changed = Object.entries(draft.value).filter(
    ([key, value]) => value !== kEmpty[key as keyof Draft],
  );
  if (kept) draft.value = { ...kEmpty, ...renewed(kept), ...Object.fromEntries(changed) };
  let timer = 0;
  effect(() => {
    const value = draft.value;
    window.clearTimeout(timer);
    timer = window.setTimeout(() => void save(kDraftKey, value), 200);
  });
}

/** A draft of an earlier version of this page. */
interface OldDraft {
  projection?: Parameters<typeof layerOfOldDraft>[0];
}

/** Reads a stored draft, also one of an earlier version. */
export function renewed({ projection, ...kept }: Draft & OldDraft): Draft {
  return projection && !kept.layer ? { ...kept, layer: layerOfOldDraft(projection) } : kept;
}

/** The length of a unit that the file format defines (glTF: metre), mm. */
export const unitOfFormat = (name: string): number | undefined =>
  /\.(gltf|glb)$/i.test(name) ? 1000 : undefined;

export function clear(): void {
  batch(() => {
    shape.value = undefined;
    draft.value = { ...kEmpty };
    markRefused('job');
  });
}

/**
 * Fills the draft from a job's spec, and marks the field for which the job failed. The caller must load the shape of the
 * model.
 */
export async function startFrom(name: string): Promise<Result<Job>> {
  const answer = await jobsApi.get(name);
  if (!answer.ok) return answer;
  const { labels, error } = answer.value;
  const from = sourceOf(answer.value);
  if (!from)
    return refused(
      `job ${numberOf(name)} is not a simulation or a plan`,
      'Open a simulation or a plan and press “Run again with changes”',
    );
  const { spec } = from;
  batch(() => {
    shape.value = undefined;
    draft.value = {
      ...kEmpty,
      from,
      name: answer.value.displayName,
      scale: spec.scale ?? 1,
      layer: pictureOf(spec)?.layer ?? {},
      film: spec.film ?? 'A4',
      dpi: spec.dpi ?? 300,
      paper: labels['paper'] ?? kEmpty.paper,
      colours: labels['colours'] === 'COLOURS_CMYK' ? 'COLOURS_CMYK' : 'COLOURS_RGB',
      model: spec.model === 'MODEL_STOKES' ? 'MODEL_STOKES' : 'MODEL_SHEET',
      speed_mm_per_s: spec.dipSpeedMmPerS ?? 5,
      requestId: newRequestId(),
    };
    markRefused('job', error && [{ field: error.field, description: error.message }]);
  });
  return done(answer.value);
}

function sourceOf({ name: job, simulate, plan }: Job): Source | undefined {
  if (simulate) return { job, spec: simulate };
  if (!plan) return undefined;
  const { object, film, dpi, immersions, blendMm } = plan;
  const spec = { ...film, ...object, ...(dpi ? { dpi } : {}) } as SimulateSpec;
  return { job, spec, plan: { immersions, ...(blendMm ? { blendMm } : {}) } };
}

/** Uses the dips of the job, unless the draft has them already. The shape must be loaded first. */
export function takeDipsOfJob(): void {
  const { from } = draft.value;
  if (!from || from.isTaken) return;
  const dips = (from.plan?.immersions ?? [from.spec]).map(({ pose, depthMm }) => ({
    pose: fromApi(pose, centre_mm.value) ?? kUpright,
    depth_mm: depthMm || undefined,
  }));
  change({ ...split(dips, 0), from: { ...from, isTaken: true } });
}

/** The input files of the new job: uploaded files, and files of job `from`. */
export interface Inputs {
  mesh: InputFile;
  texture?: InputFile;
  /** True if the model has colours, which show around a decal. */
  hasOwnColours?: boolean;
  /** The paint of job `from`, unless there is a texture. */
  paint?: SimulateSpecInput['paint'];
  extraFiles: InputFile[];
  profile?: InputFile;
}

/** The picture in a spec. */
const picture = ({ texture, hasOwnColours = false }: Inputs, { layer }: Draft) =>
  texture ? pictureSpec(texture, layer, hasOwnColours) : {};

/** Builds the simulation of the selected dip. */
export function simulateOf(value: Draft, inputs: Inputs, box_mm: Vec3): SimulateSpecInput {
  const measured = value.calibration !== '';
  const { texture: _, hasOwnColours: __, ...files } = inputs;
  return {
    ...files,
    ...(measured
      ? { calibration: value.calibration }
      : { scale: value.scale, pose: toApi(value.pose, box_mm), film: value.film }),
    ...picture(inputs, value),
    dpi: value.dpi,
    model: value.model,
    dipSpeedMmPerS: value.speed_mm_per_s,
    ...(value.depth_mm ? { depthMm: value.depth_mm } : {}),
  };
}

/** Builds the plan that divides the picture among all dips. */
function planOf(value: Draft, inputs: Inputs, box_mm: Vec3): PlanSpecInput {
  const { mesh, extraFiles, profile, paint } = inputs;
  const blendMm = value.from?.plan?.blendMm;
  return {
    object: {
      mesh,
      extraFiles,
      scale: value.scale,
      ...(paint ? { paint } : {}),
      ...picture(inputs, value),
    },
    immersions: dipsOf(value).map(({ pose, depth_mm }) => ({
      pose: toApi(pose, box_mm),
      ...(depth_mm ? { depthMm: depth_mm } : {}),
    })),
    film: {
      film: value.film,
      model: value.model,
      dipSpeedMmPerS: value.speed_mm_per_s,
      ...(profile ? { profile } : {}),
    },
    dpi: value.dpi,
    ...(blendMm ? { blendMm } : {}),
  };
}

/** Builds the request that creates the job: a simulation of one dip, or a plan of several. */
export function jobOf(value: Draft, inputs: Inputs, box_mm: Vec3): JobInput {
  return {
    displayName: value.name,
    labels: { paper: value.paper, colours: value.colours },
    ...(dipsOf(value).length > 1
      ? { plan: planOf(value, inputs, box_mm) }
      : { simulate: simulateOf(value, inputs, box_mm) }),
  };
}
