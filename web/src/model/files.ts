/**
 * Classifies dropped files. Every unusable file is refused with a reason and a remedy; none is ignored silently.
 */

export interface Named {
  name: string;
}

/** 'material': belongs to the model, such as an MTL, or the buffer of a glTF. */
export type Role = 'mesh' | 'material' | 'image' | 'profile';

/** The role of a file by its name, or the reason why the file cannot be used. */
export function roleOf(name: string): Role | { why: string } {
  if (!name.includes('.')) return { why: kNoEnding };
  const ending = name.toLowerCase().split('.').at(-1) ?? '';
  const role = kRoles[ending];
  if (role) return role;
  const why = kRefusals[ending];
  return { why: why ?? `files of type ".${ending}" are not supported. ${kWanted}` };
}

const kWanted =
  'Drop a model (OBJ, PLY, STL or glTF), its MTL or BIN and images (PNG, JPEG or TIFF), or a film profile (TOML)';

const kNoEnding = `the name has no file extension. ${kWanted}. If this is a folder, drop the files inside it`;

const kRoles: Record<string, Role> = {
  obj: 'mesh', ply: 'mesh', stl: 'mesh', glb: 'mesh', gltf: 'mesh',
  mtl: 'material', bin: 'material',
  png: 'image', jpg: 'image', jpeg: 'image', tif: 'image', tiff: 'image',
  toml: 'profile',
}; // prettier-ignore

const kCad = 'this is a CAD file without a surface mesh. Export the model as STL, PLY or OBJ';
const kRefusals: Record<string, string> = {
  zip: 'this is an archive. Unpack it, then drop the extracted files here',
  rar: 'this is an archive. Unpack it, then drop the extracted files here',
  step: kCad,
  stp: kCad,
  f3d: kCad,
  blend: 'Blender files cannot be read. Export the model as OBJ from Blender',
  '3mf': '3MF cannot be read. Export the model as OBJ, PLY or STL',
  gcode:
    'this is a tool path, not a model. Drop the OBJ, PLY or STL file from which the tool path was made',
  webp: 'WebP cannot be read. Save the image as PNG or JPEG',
  heic: 'HEIC cannot be read. Save the image as PNG or JPEG',
  gif: 'GIF cannot be read. Save the image as PNG or JPEG',
  svg: 'SVG cannot be read. Save the image as PNG',
  bmp: 'BMP cannot be read. Save the image as PNG',
  pdf: 'PDF cannot be read. Save the image as PNG',
};

/** Checks the first bytes of an image against its name. Returns the reason if they differ, undefined if they agree. */
export function contradiction(role: Role, head: Uint8Array): string | undefined {
  if (head.length === 0) return 'the file is empty. Copy or export it again';
  const begins = (...bytes: number[]) => bytes.every((byte, i) => head[i] === byte);
  const isImage =
    begins(0x89, 0x50, 0x4e, 0x47) ||
    begins(0xff, 0xd8, 0xff) ||
    begins(0x49, 0x49, 0x2a, 0) ||
    begins(0x4d, 0x4d, 0, 0x2a);
  return role !== 'image' || isImage
    ? undefined
    : 'the file is not a PNG, JPEG or TIFF. Save the image as PNG or JPEG';
}

/** The name without its folder. */
export const baseOf = (path: string): string => path.replaceAll('\\', '/').split('/').at(-1)!;

const keyOf = (path: string): string => baseOf(path).normalize('NFC').toLowerCase();

/** True if the paths name the same file, whatever their folder, case and Unicode form. */
export const isSameFile = (a: string, b: string): boolean => keyOf(a) === keyOf(b);

/** The name of a file in a job, which the API must accept. */
export function nameFor(file: Named): string {
  const own = file.name.replace(/[\\/\p{Cc}]/gu, '_').replace(/^-+/, '');
  return own === '' || own === '.' || own === '..' ? 'file' : own;
}
