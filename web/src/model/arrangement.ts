/** Finds out how the files of a print refer to each other, and which of them are missing. */
import { baseOf, isSameFile, nameFor, type Named } from './files';
import type { Mesh, SurfaceMaterial } from './mesh';
import { readMtl } from './mtl';

/** The model's file, with the parts of its mesh that refer to other files. */
export interface ModelFile extends Named {
  mesh: Pick<Mesh, 'libraries' | 'materials' | 'parts' | 'uvs' | 'colours'>;
}

/** A file that another file names, but that was not dropped. */
export interface MissingFile {
  name: string;
  /** Name of the file that refers to it. */
  by: string;
}

type Materials<F> = Map<string, SurfaceMaterial & { file?: F }>;

/** How the files refer to each other. */
export interface Arrangement<F extends Named> {
  /** MTL files and the images that they reference, under the referenced names. */
  extra: { name: string; file: F }[];
  /** The texture of the whole object, used instead of the materials' images. */
  texture?: F;
  /** Images that neither a material references nor the object has as its texture. */
  unused: F[];
  /** The files without which the model lacks colours; none if the object has a texture. */
  missing: MissingFile[];
  /** The appearance of each material, with its image if present. */
  materials: Materials<F>;
  /** True if the model has colours without the texture, and all files for them are present. */
  hasOwnColours: boolean;
}

interface Mtl<F> {
  file: F;
  text: string;
}

/** `model` is undefined before a model is added, and if the model comes from a job. */
export function arrange<F extends Named>(
  model: ModelFile | undefined,
  mtl: readonly Mtl<F>[],
  images: readonly F[],
): Arrangement<F> {
  const sources = sourcesOf(model, mtl);
  const materials: Materials<F> = new Map();
  for (const { material, name } of sources) {
    const file = images.find((image) => material.map && isSameFile(image.name, material.map));
    materials.set(name, { ...material, ...(file ? { file } : {}) });
  }
  const named = new Set([...materials.values()].map(({ file }) => file));
  const free = images.filter((image) => !named.has(image));
  const texture = free[0] ?? pictureToProject(model, materials);
  const extra = [...mtl.map(({ file }) => file), ...images]
    .filter((file) => file !== texture && !free.includes(file))
    .map((file) => ({ name: nameFor(file, referencesOf(model, materials)), file }));
  const lacking = model ? missingOf(model, mtl, sources, materials) : [];
  return {
    extra,
    unused: free.slice(1),
    missing: texture ? [] : lacking,
    materials,
    hasOwnColours: model !== undefined && lacking.length === 0 && isColoured(model, materials),
    ...(texture ? { texture } : {}),
  };
}

interface Source {
  name: string;
  material: SurfaceMaterial;
  /** Name of the file that defines the material. */
  by: string;
}

/** The materials by name. If several have the same name, the first counts, as in the worker. */
function sourcesOf<F extends Named>(model: ModelFile | undefined, mtl: readonly Mtl<F>[]) {
  const out = new Map<string, Source>();
  const add = (materials: Iterable<[string, SurfaceMaterial]>, by: string) => {
    for (const [name, material] of materials)
      if (!out.has(name)) out.set(name, { name, material, by });
  };
  for (const { file, text } of mtl) add(readMtl(text), file.name);
  if (model) add(model.mesh.materials ?? [], model.name);
  return [...out.values()];
}

const referencesOf = (model: ModelFile | undefined, materials: Materials<Named>): string[] => [
  ...(model?.mesh.libraries ?? []),
  ...[...materials.values()].flatMap(({ map }) => (map ? [map] : [])),
];

/** The names of the materials that triangles have. */
const usedBy = (model: ModelFile): Set<string> =>
  new Set(model.mesh.parts.map(({ material }) => material).filter((name) => name !== ''));

/** The image of the materials, if the mesh lacks the texture coordinates that materials need and there is one image. */
function pictureToProject<F extends Named>(
  model: ModelFile | undefined,
  materials: Materials<F>,
): F | undefined {
  if (!model || model.mesh.uvs) return undefined;
  const files = new Set([...usedBy(model)].flatMap((name) => materials.get(name)?.file ?? []));
  return files.size === 1 ? [...files][0] : undefined;
}

/** True if the model has colours of vertices, or materials whose images it can show. */
function isColoured<F>(model: ModelFile, materials: Materials<F>): boolean {
  const { mesh } = model;
  const used = [...usedBy(model)].flatMap((name) => materials.get(name) ?? []);
  const canShow = mesh.uvs !== undefined || used.every(({ map, picture }) => !map && !picture);
  return mesh.colours !== undefined || (used.length > 0 && canShow);
}

function missingOf<F extends Named>(
  model: ModelFile,
  mtl: readonly Mtl<F>[],
  sources: readonly Source[],
  materials: Materials<F>,
): MissingFile[] {
  const used = usedBy(model);
  const out = new Map<string, MissingFile>();
  const add = (path: string, by: string) =>
    out.set(baseOf(path).toLowerCase(), { name: baseOf(path), by });
  const lacksMaterials = !model.mesh.colours && [...used].some((name) => !materials.has(name));
  // A line may name one file or several.
  for (const line of lacksMaterials ? model.mesh.libraries : []) {
    const names = [line, ...line.split(/\s+/)];
    if (!names.some((name) => has(mtl, name))) add(line, model.name);
  }
  for (const { name, material, by } of sources)
    if (material.map && used.has(name) && !materials.get(name)?.file) add(material.map, by);
  return [...out.values()];
}

const has = <F extends Named>(mtl: readonly Mtl<F>[], name: string): boolean =>
  mtl.some(({ file }) => isSameFile(file.name, name));

/** Says which files to add before the simulation; undefined if none is missing. */
export function remedyForMissing(missing: readonly MissingFile[]): string | undefined {
  const [first, ...others] = missing;
  if (!first) return undefined;
  const more = others.length === 1 ? ' and 1 more file' : ` and ${others.length} more files`;
  const named = `Add "${first.name}", which ${first.by} names,`;
  return `${named}${others.length > 0 ? `${more},` : ''} or choose another texture`;
}
