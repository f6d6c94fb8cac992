/** Reads the binary glTF that the daemon makes of a model (DisplayModel in the API). */
import type { BufferAttribute, Mesh as Mesh3, MeshBasicMaterial, Texture, Vector3 } from 'three';
import type { GLTF, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import type { ModelSummary } from '../api/types';
import type { Box, Look, Mesh, Wrap } from '../model/mesh';
import { done, refused, type Result } from '../model/result';
import { readPicture } from '../paint/paint';
import type { Model, Places } from './engine';

export async function modelOf(glb: ArrayBuffer): Promise<Result<Model>> {
  try {
    const three = await import('three');
    const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
    const loader = new GLTFLoader();
    // The loader would read textures through blob: URLs, which the page does not allow.
    loader.register((parser) => ({
      name: 'textures',
      loadTexture: async (index: number) => textureOf(new three.Texture(), parser, index),
    }));
    const gltf = await loader.parseAsync(glb, '');
    return done(gathered(gltf, inCamelCase(gltf.asset.extras) as ModelSummary));
  } catch {
    return refused('the model cannot be shown', 'Reload the page');
  }
}

/** Gives a JSON file's values the names that they have in the API. */
function inCamelCase(value: unknown): unknown {
  if (Array.isArray(value)) return value.map(inCamelCase);
  if (typeof value !== 'object' || value === null) return value;
  const name = (key: string) => key.replace(/_./g, (part) => part[1]!.toUpperCase());
  return Object.fromEntries(Object.entries(value).map(([k, v]) => [name(k), inCamelCase(v)]));
}

/** Fills a texture with its picture, which may be missing if the browser has too little memory, and its wrap. */
async function textureOf(texture: Texture, parser: GLTFParser, index: number): Promise<Texture> {
  const { textures, images, samplers } = parser.json as {
    textures: { source: number; sampler: number }[];
    images: { bufferView: number; mimeType: string }[];
    samplers: { wrapS: number; wrapT: number }[];
  };
  const { source, sampler } = textures[index]!;
  const { bufferView, mimeType: type } = images[source]!;
  const bytes = (await parser.getDependency('bufferView', bufferView)) as ArrayBuffer;
  texture.image = await readPicture(new Blob([bytes], { type }));
  const { wrapS, wrapT } = samplers[sampler]!;
  texture.userData['wrap'] = [wrapOf(wrapS), wrapOf(wrapT)];
  return texture;
}

function gathered({ scene }: GLTF, summary: ModelSummary): Model {
  const parts: Mesh3[] = [];
  scene.traverse((one) => {
    if ('isMesh' in one) parts.push(one as Mesh3);
  });
  scene.updateMatrixWorld();
  // All parts have the same vertices.
  const { attributes } = parts[0]!.geometry;
  const origin_mm = parts[0]!.getWorldPosition(parts[0]!.position.clone());
  let first = 0;
  const ranges = parts.map((part) => {
    const { count } = part.geometry.index!;
    first += count;
    const look = lookOf(part.material as MeshBasicMaterial, summary);
    return { look, first: first - count, count };
  });
  const indices = new Uint32Array(first);
  ranges.forEach((range, i) => indices.set(parts[i]!.geometry.index!.array, range.first));
  const positions_mm = moved(attributes['position'] as BufferAttribute, origin_mm);
  const uvs = attributes['uv'] && upward(attributes['uv'] as BufferAttribute);
  const colours = attributes['color'] && coloursOf(attributes['color'] as BufferAttribute);
  // The loader writes the names of attributes in lower case.
  const places = placesOf(attributes['_place'] as BufferAttribute, positions_mm, indices);
  const positions = positions_mm.map((value) => value / summary.scale);
  const mesh: Mesh = {
    positions,
    indices,
    parts: ranges,
    ...(uvs ? { uvs } : {}),
    ...(colours ? { colours } : {}),
  };
  return { mesh, box: boxOf(summary), places, summary };
}

function boxOf({ lowestMm, highestMm, scale }: ModelSummary): Box {
  const corner = ([x = 0, y = 0, z = 0]: number[]) => [x / scale, y / scale, z / scale] as const;
  return { min: corner(lowestMm), max: corner(highestMm) };
}

/** The look of models without any colour. */
const kGrey = 0.69;

function lookOf({ color, map }: MeshBasicMaterial, { hasColour }: ModelSummary): Look {
  if (!hasColour) return { colour: [kGrey, kGrey, kGrey] };
  const look: Look = { colour: [color.r, color.g, color.b] };
  if (!map) return look;
  return { ...look, picture: map.image as ImageBitmap, wrap: map.userData['wrap'] as [Wrap, Wrap] };
}

// Numbers of the glTF 2.0 specification.
const wrapOf = (code: number): Wrap =>
  code === 33071 ? 'clamp' : code === 33648 ? 'mirror' : 'repeat';

function moved({ array }: BufferAttribute, { x, y, z }: Vector3): Float32Array {
  const by = [x, y, z];
  return Float32Array.from(array, (value, i) => value + by[i % 3]!);
}

/** In glTF, v points downwards. */
const upward = ({ array }: BufferAttribute): Float32Array =>
  Float32Array.from(array, (value, i) => (i % 2 ? 1 - value : value));

/** Leaves out alpha. */
const coloursOf = ({ array, count }: BufferAttribute): Uint16Array =>
  Uint16Array.from({ length: 3 * count }, (_, i) => array[4 * Math.floor(i / 3) + (i % 3)]!);

function placesOf(
  place: BufferAttribute,
  positions_mm: Float32Array,
  indices: Uint32Array,
): Places {
  let last = -1;
  for (const number of place.array) last = Math.max(last, number);
  const positions = new Float32Array(3 * (last + 1));
  place.array.forEach((number, i) =>
    positions.set(positions_mm.subarray(3 * i, 3 * i + 3), 3 * number),
  );
  return { positions, corners: indices.map((vertex) => place.array[vertex]!) };
}
