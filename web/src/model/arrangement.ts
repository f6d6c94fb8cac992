/** Finds out which of a print's files belong to each other, and which are missing. */
import type { ModelSummary } from '../api/types';
import { baseOf, isSameFile, nameFor, type Named } from './files';

/** How the files belong together. */
export interface Arrangement<F extends Named> {
  /** Files that the model's colours come from, with their names in the job. */
  extra: { name: string; file: F }[];
  /** The texture of the whole object, used instead of the model's own. */
  texture?: F;
  /** Images that neither the model names nor the object has as its texture. */
  unused: F[];
  /** Names of the files without which the model lacks colours; none if the object has a texture. */
  missing: string[];
  /** True if the model has colours without the texture, and all files for them are present. */
  hasOwnColours: boolean;
}

/**
 * @param summary    what was read of the model; undefined before
 * @param materials  files that belong to the model whatever their name
 */
export function arrange<F extends Named>(
  summary: ModelSummary | undefined,
  materials: readonly F[],
  images: readonly F[],
): Arrangement<F> {
  const companions = summary?.companions ?? [];
  const named = images.filter((image) => isNamed(image, companions));
  const free = images.filter((image) => !named.includes(image));
  const texture = free[0] ?? pictureToProject(summary, named);
  const missing = companions.filter(({ isMissing }) => isMissing).map(({ name }) => baseOf(name));
  return {
    extra: [...materials, ...named]
      .filter((file) => file !== texture)
      .map((file) => ({ name: nameFor(file), file })),
    unused: free.slice(1),
    missing: texture ? [] : [...new Set(missing)],
    hasOwnColours: summary?.hasColour ?? false,
    ...(texture ? { texture } : {}),
  };
}

/** True if a model names the file. */
export const isNamed = (file: Named, companions: ModelSummary['companions']): boolean =>
  companions.some(({ name }) => isSameFile(file.name, name));

/** The only image that a model without texture coordinates names: it cannot use it, but it can be projected. */
const pictureToProject = <F extends Named>(
  summary: ModelSummary | undefined,
  named: readonly F[],
) => (summary && !summary.hasTextureCoordinates && named.length === 1 ? named[0] : undefined);

/** Says which files to add before the simulation; undefined if none is missing. */
export function remedyForMissing(missing: readonly string[]): string | undefined {
  const [first, ...others] = missing;
  if (!first) return undefined;
  const more = others.length === 1 ? ' and 1 more file' : ` and ${others.length} more files`;
  const named = `Add "${first}", which the model names,`;
  return `${named}${others.length > 0 ? `${more},` : ''} or choose another texture`;
}
