/** The picture's layer in a job's spec. */
import type { InputFile, SimulateSpec, SimulateSpecInput } from '../../../api/types';
import { layerOf, layerSpec, type LayerSpec, type ProjectionName } from '../../../paint/layer';
import { onlyChosen, type LayerChoices } from './choices';

/** The model's own colours as a layer. */
const kOwnColours: LayerSpec = { projection: 'uv' };

/** The fields of a layer. Without a chosen projection, the worker's default. */
function fieldsOf(chosen: LayerChoices): LayerSpec {
  const { projection, ...others } = layerSpec({ projection: 'uv', ...chosen });
  return chosen.projection ? { projection, ...others } : others;
}

/** True if nothing was chosen that `texture` alone does not say. */
const isPlain = ({ projection, ...others }: LayerChoices): boolean =>
  Object.keys(others).length === 0 && (!projection || projection === 'uv');

/**
 * The texture if nothing was chosen, otherwise a paint.
 * @param hasOwnColours  true if the model has colours, which show around a decal
 */
export function pictureSpec(
  texture: InputFile,
  choices: LayerChoices,
  hasOwnColours: boolean,
): Pick<SimulateSpecInput, 'texture' | 'paint'> {
  const chosen = onlyChosen(choices);
  if (isPlain(chosen)) return { texture };
  const below = isAboveOwnColours(chosen, hasOwnColours) ? [kOwnColours] : [];
  return { paint: { layers: [...below, { picture: texture, ...fieldsOf(chosen) }] } };
}

/** True if the model's own colours show around the picture. */
export const isAboveOwnColours = ({ projection }: LayerChoices, hasOwnColours: boolean): boolean =>
  projection === 'decal' && hasOwnColours;

/** What this page knows of the picture of a job. */
export interface KnownPicture {
  texture?: InputFile;
  layer: LayerChoices;
  hasOwnColours: boolean;
}

type Paint = NonNullable<SimulateSpec['paint']>;

/** The picture of a spec; undefined if its paint has parts that this page cannot change. */
export function pictureOf(spec: SimulateSpec): KnownPicture | undefined {
  if (spec.paint) return onlyPicture(spec.paint);
  const texture = spec.texture as InputFile | undefined;
  const layer = onlyChosen({
    projection: spec.project as ProjectionName | undefined,
    size_mm: spec.projectSizeMm,
    turn_deg: spec.projectTurnDeg,
  });
  return { ...(texture ? { texture } : {}), layer, hasOwnColours: false };
}

function onlyPicture({ baseColour, layers }: Paint): KnownPicture | undefined {
  const hasOwnColours = layers.length === 2 && isOwnColours(layers[0]!);
  const [layer, ...others] = hasOwnColours ? layers.slice(1) : layers;
  const hasBase = baseColour !== undefined && baseColour !== '#ffffff';
  if (!layer?.picture || others.length > 0 || hasBase) return undefined;
  const isKnown = !hasOwnColours || layer.projection === 'decal';
  if (!isKnown || layer.projection === 'vertex_colors') return undefined;
  return { texture: layer.picture as InputFile, layer: choicesOf(layer), hasOwnColours };
}

const isOwnColours = (layer: Paint['layers'][number]): boolean =>
  !layer.picture && !layer.colour && layer.projection === 'uv' && layer.opacity === undefined;

function choicesOf(layer: Paint['layers'][number]): LayerChoices {
  const known = layerOf(layer as LayerSpec, 'uv');
  return onlyChosen({ ...known, projection: layer.projection ? known.projection : undefined });
}

/** The layer of a draft that an earlier version of this page stored. */
export const layerOfOldDraft = (old: {
  kind?: ProjectionName;
  size_mm?: number;
  turn_deg?: number;
}): LayerChoices =>
  onlyChosen({ projection: old.kind, size_mm: old.size_mm, turn_deg: old.turn_deg });
