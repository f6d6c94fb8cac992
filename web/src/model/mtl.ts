import type { SurfaceMaterial } from './mesh';

/** Decodes UTF-8, or Latin-1, which old exporters write. */
export function decodeText(bytes: ArrayBuffer): string {
  try {
    return new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder('latin1').decode(bytes);
  }
}

/** Reads an MTL: maps each material's name to its displayed properties. */
export function readMtl(text: string): Map<string, SurfaceMaterial> {
  const materials = new Map<string, SurfaceMaterial>();
  const ambient = new Map<SurfaceMaterial, string>();
  let current: SurfaceMaterial | undefined;
  for (const raw of text.split(/\r\n|\r|\n/)) {
    const line = raw.trim();
    const [word = '', ...words] = line.split(/\s+/);
    const keyword = word.toLowerCase();
    const rest = line.slice(word.length).trim();
    if (keyword === 'newmtl') {
      current = { colour: [1, 1, 1] };
      materials.set(rest, current);
    } else if (keyword === 'kd' && current) {
      const [r, g, b] = words.map(Number);
      if ([r, g, b].every((c) => Number.isFinite(c))) current.colour = [r!, g!, b!];
    } else if (keyword === 'map_kd' && current) {
      current.map = imageNameOf(rest);
    } else if (keyword === 'map_ka' && current) {
      ambient.set(current, imageNameOf(rest));
    }
  }
  // As the worker does, map_Ka is used if there is no map_Kd.
  for (const [material, name] of ambient) material.map ??= name;
  return materials;
}

// The options of a map with the least and the largest count of their numbers. [0, 0]: one word.
const kOptions: Record<string, readonly [number, number]> = {
  '-blendu': [0, 0], '-blendv': [0, 0], '-cc': [0, 0], '-clamp': [0, 0],
  '-imfchan': [0, 0], '-type': [0, 0], '-colorspace': [0, 0],
  '-bm': [1, 1], '-boost': [1, 1], '-texres': [1, 2], '-mm': [1, 2],
  '-o': [1, 3], '-s': [1, 3], '-t': [1, 3],
}; // prettier-ignore

/** The image's name in the arguments of a map. It may contain spaces; options come before or after it. */
export function imageNameOf(text: string): string {
  const name = withoutOptions(text.trim());
  for (let at = name.indexOf(' -'); at >= 0; at = name.indexOf(' -', at + 1))
    if (withoutOptions(name.slice(at).trim()) === '') return unquoted(name.slice(0, at).trim());
  return unquoted(name);
}

const unquoted = (name: string): string => name.replace(/^"(.+)"$/, '$1');

function withoutOptions(text: string): string {
  let rest = text;
  for (let next = withoutOption(rest); next !== undefined; next = withoutOption(rest)) rest = next;
  return rest;
}

/** Removes the option at the front. Returns undefined if the line starts with something else. */
function withoutOption(text: string): string | undefined {
  const option = kOptions[/^-\S+/.exec(text)?.[0].toLowerCase() ?? ''];
  if (!option) return undefined;
  const [least, most] = option;
  let rest = withoutWord(text);
  if (most === 0) return rest === '' ? undefined : withoutWord(rest);
  let count = 0;
  for (; count < most && isNumber(/^\S+/.exec(rest)?.[0]); count += 1) rest = withoutWord(rest);
  return count < least ? undefined : rest;
}

const withoutWord = (text: string): string => text.replace(/^\S+\s*/, '');

const isNumber = (word: string | undefined): boolean =>
  word !== undefined && Number.isFinite(Number(word));
