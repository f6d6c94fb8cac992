/**
 * Which of the dropped files is what. Files that are no use are refused, each with the reason and what to do;
 * nothing is left out silently.
 */
import type { Worn } from './mesh';
import { readMtl } from './obj';

export interface Named {
  name: string;
}

export type Role = 'mesh' | 'material' | 'image' | 'profile';

/** What is known of a file by its name; or why it is no use. */
export function roleOf(name: string): Role | { why: string } {
  const ending = name.toLowerCase().split('.').at(-1) ?? '';
  const role = kRoles[ending];
  if (role) return role;
  const why = kRefusals[ending];
  return { why: why ?? `what a ".${ending}" is, is not known here. ${kWanted}` };
}

const kWanted =
  'Drop a model (OBJ, PLY, STL or glTF), its MTL and its pictures (PNG, JPEG or TIFF), or a film profile (TOML)';

const kRoles: Record<string, Role> = {
  obj: 'mesh', ply: 'mesh', stl: 'mesh', glb: 'mesh', gltf: 'mesh',
  mtl: 'material',
  png: 'image', jpg: 'image', jpeg: 'image', tif: 'image', tiff: 'image',
  toml: 'profile',
}; // prettier-ignore

const kCad = 'this is a CAD file without a surface. Export it as STL, PLY or OBJ';
const kRefusals: Record<string, string> = {
  bin: 'this is a part of a glTF model. Export that as GLB, which has all in one',
  zip: 'this is an archive. Unpack it and drop the files in it',
  rar: 'this is an archive. Unpack it and drop the files in it',
  step: kCad,
  stp: kCad,
  f3d: kCad,
  blend: 'Blender files cannot be read. Export the model as OBJ from Blender',
  '3mf': '3MF cannot be read. Export the model as OBJ, PLY or STL',
  gcode: 'this is a path of a printer, not a model. Drop the OBJ, PLY or STL it was made from',
  webp: 'WebP cannot be read. Save the picture as PNG or JPEG',
  heic: 'HEIC cannot be read. Save the picture as PNG or JPEG',
  gif: 'GIF cannot be read. Save the picture as PNG or JPEG',
  svg: 'SVG cannot be read. Save the picture as PNG',
  bmp: 'BMP cannot be read. Save the picture as PNG',
  pdf: 'PDF cannot be read. Save the picture as PNG',
};

/** Why the first bytes of a file are not what its name says; undefined if they may well be. */
export function contradiction(role: Role, name: string, head: Uint8Array): string | undefined {
  if (head.length === 0) return 'the file is empty. Copy or export it again';
  const begins = (...bytes: number[]) => bytes.every((byte, i) => head[i] === byte);
  if (role === 'image') {
    const isImage =
      begins(0x89, 0x50, 0x4e, 0x47) ||
      begins(0xff, 0xd8, 0xff) ||
      begins(0x49, 0x49, 0x2a, 0) ||
      begins(0x4d, 0x4d, 0, 0x2a);
    return isImage ? undefined : 'it is not a picture, whatever its name. Save it as PNG or JPEG';
  }
  const text = new TextDecoder('latin1').decode(head);
  if (/\.ply$/i.test(name) && !text.startsWith('ply'))
    return 'it does not begin like a PLY file. Export it again as PLY';
  if (/\.glb$/i.test(name) && !text.startsWith('glTF'))
    return 'it does not begin like a GLB file. Export it again as GLB';
  if (/\.gltf$/i.test(name) && !/^\s*\{/.test(text) && !text.startsWith('glTF'))
    return 'it does not begin like a glTF file. Export it again as GLB';
  if (
    /\.obj$/i.test(name) &&
    (head.includes(0) || !/^\s*(#|v|o|g|f|mtllib|usemtl|s)\b/m.test(text))
  )
    return 'it does not read like an OBJ file. Export it again as OBJ';
  return undefined;
}

const baseOf = (path: string): string =>
  path.replaceAll('\\', '/').split('/').at(-1)!.toLowerCase();

/** True for a name that the API takes for a job's file (InputFile.name). */
export const isPlain = (name: string): boolean =>
  name.length > 0 &&
  new TextEncoder().encode(name).length <= 255 &&
  !/[\\\p{Cc}]/u.test(name) &&
  name
    .split('/')
    .every((part) => part !== '' && part !== '.' && part !== '..' && !part.startsWith('-'));

/** The name under which a job sees a file: the one by which others refer to it, if that is plain. */
export function nameFor(file: Named, references: readonly string[]): string {
  const reference = references.find((path) => baseOf(path) === baseOf(file.name));
  const wanted = reference?.replaceAll('\\', '/');
  if (wanted !== undefined && isPlain(wanted)) return wanted;
  const own = file.name.replace(/[\\/\p{Cc}]/gu, '_').replace(/^-+/, '');
  return own === '' || own === '.' || own === '..' ? 'file' : own;
}

/** What the files are to each other. */
export interface Arrangement<F extends Named> {
  /** MTL files and the pictures they name, under the names by which they are named. */
  extra: { name: string; file: F }[];
  /** A picture that nothing names: the texture of the whole. */
  texture?: F;
  /** Files that were named and are not there, in words. */
  missing: string[];
  /** What each material looks like, with the picture of it that is there. */
  materials: Map<string, Worn & { file?: F }>;
}

/**
 * `libraries` are those that the mesh names; `mtl` is the text of each material file; `own` the materials that the mesh
 * brings itself.
 */
export function arrange<F extends Named>(
  libraries: readonly string[],
  mtl: readonly { file: F; text: string }[],
  images: readonly F[],
  own: ReadonlyMap<string, Worn> = new Map(),
): Arrangement<F> {
  const materials = new Map<string, Worn & { file?: F }>();
  const missing: string[] = [];
  const extra: Arrangement<F>['extra'] = [];
  const named = new Set<F>();
  const add = (name: string, material: Worn) => {
    const image = images.find((i) => material.map && baseOf(i.name) === baseOf(material.map));
    if (material.map && !image) missing.push(`the picture "${material.map}" of material "${name}"`);
    if (material.map && image && !named.has(image)) {
      named.add(image);
      extra.push({ name: nameFor(image, [material.map]), file: image });
    }
    materials.set(name, { ...material, ...(image ? { file: image } : {}) });
  };
  for (const library of libraries)
    if (!mtl.some(({ file }) => baseOf(file.name) === baseOf(library)))
      missing.push(`the material file "${library}"`);
  for (const { file, text } of mtl) {
    extra.push({ name: nameFor(file, libraries), file });
    for (const [name, material] of readMtl(text)) add(name, material);
  }
  for (const [name, material] of own) add(name, material);
  const texture = images.find((image) => !named.has(image));
  return { extra, missing, materials, ...(texture ? { texture } : {}) };
}
