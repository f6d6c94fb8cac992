/** What the user chose of the picture's layer. Defaults are the worker's; see PaintLayer in spec.proto. */
import type { Quaternion } from '../../../model/pose';
import type { PaintLayer, ProjectionName } from '../../../paint/layer';
import { lookFrom } from './directions';

export type LayerChoices = Partial<PaintLayer>;

type Field = Exclude<keyof PaintLayer, 'projection'>;

const kPlaced: readonly ProjectionName[] = ['planar', 'dip', 'cylindrical', 'box', 'decal'];

/** The projections that have an option. Options that are not listed apply to all. */
const kProjectionsOf: Partial<Record<Field, readonly ProjectionName[]>> = {
  position_mm: kPlaced,
  direction: ['planar', 'cylindrical', 'box', 'decal'],
  up: kPlaced,
  size_mm: kPlaced,
  depth_mm: ['decal'],
  turn_deg: kPlaced,
  mirror: kPlaced,
  repeat: ['uv', 'planar', 'dip', 'cylindrical', 'box'],
  blend_mm: ['box'],
};

/** True if layers with this projection have the option. The API refuses others. */
export const hasOption = (projection: ProjectionName, field: Field): boolean =>
  kProjectionsOf[field]?.includes(projection) ?? true;

export const isPlaced = (projection: ProjectionName): boolean => kPlaced.includes(projection);

/** True for projections that repeat the picture unless told otherwise. */
export const repeatsByDefault = (projection: ProjectionName): boolean =>
  projection === 'cylindrical' || projection === 'box' || projection === 'uv';

/** The projection that is used: the chosen one, or the worker's default. */
export const projectionIn = (
  { projection }: LayerChoices,
  lacksCoordinates: boolean,
): ProjectionName => {
  if (projection && !(projection === 'uv' && lacksCoordinates)) return projection;
  return lacksCoordinates ? 'dip' : 'uv';
};

/** Removes options without a value, and options that the projection does not have. */
export function onlyChosen(choices: LayerChoices): LayerChoices {
  const { projection } = choices;
  const isMeant = (field: string) =>
    field === 'projection' || !projection || hasOption(projection, field as Field);
  const chosen = Object.entries(choices).filter(
    ([field, value]) => value !== undefined && isMeant(field),
  );
  return Object.fromEntries(chosen);
}

/** The layer with the projection that is used. */
export const layerIn = (choices: LayerChoices, lacksCoordinates: boolean): PaintLayer => {
  const projection = projectionIn(choices, lacksCoordinates);
  return { ...onlyChosen({ ...choices, projection }), projection };
};

const isDirected = (projection: ProjectionName | undefined): boolean =>
  projection === 'planar' || projection === 'decal';

/**
 * Changes the projection. The picture is fitted again, because a place or a size means something else in another
 * projection; only between the two that look along a direction it stays where it is.
 */
export function withProjection(
  choices: LayerChoices,
  projection: ProjectionName,
  rotation_FO: Quaternion,
): LayerChoices {
  if (projection === choices.projection) return choices;
  const { opacity, mirror, turn_deg } = choices;
  const isRound = projection === 'cylindrical' || choices.projection === 'cylindrical';
  const kept: LayerChoices = { opacity, mirror, turn_deg: isRound ? undefined : turn_deg };
  if (!isDirected(projection)) return onlyChosen({ ...kept, projection });
  if (isDirected(choices.projection)) return onlyChosen({ ...choices, projection });
  return onlyChosen({ ...kept, ...lookFrom('front', rotation_FO), projection });
}

/** Removes the place and the size, so that the picture is fitted to the object. */
export const fitted = ({ projection, direction, up, opacity, repeat }: LayerChoices) =>
  onlyChosen({ projection, direction, up, opacity, repeat });

/** The same layer on an object that is `factor` times as large. */
export function enlarged(choices: LayerChoices, factor: number): LayerChoices {
  const times = (value: number | undefined) => value && value * factor;
  const { position_mm, size_mm, depth_mm, blend_mm } = choices;
  return onlyChosen({
    ...choices,
    position_mm: position_mm && [
      position_mm[0] * factor,
      position_mm[1] * factor,
      position_mm[2] * factor,
    ],
    size_mm: times(size_mm),
    depth_mm: times(depth_mm),
    blend_mm: times(blend_mm),
  });
}
