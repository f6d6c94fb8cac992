/** Reads the parts of a glTF file: its JSON, and numbers from its buffers. */
import { Refusal } from './result';

export interface Primitive {
  attributes: Record<string, number>;
  indices?: number;
  material?: number;
  mode?: number;
}
interface TextureRef {
  index?: number;
  texCoord?: number;
}
/** The parts of the JSON that are read. The file is untrusted: any value may have another type. */
export interface GltfJson {
  scene?: number;
  scenes?: { nodes?: number[] }[];
  nodes?: {
    mesh?: number;
    children?: number[];
    matrix?: number[];
    translation?: number[];
    rotation?: number[];
    scale?: number[];
  }[];
  meshes?: { primitives: Primitive[] }[];
  materials?: {
    name?: string;
    pbrMetallicRoughness?: { baseColorFactor?: number[]; baseColorTexture?: TextureRef };
  }[];
  textures?: { source?: number }[];
  images?: { uri?: string; bufferView?: number; mimeType?: string }[];
  accessors?: {
    bufferView?: number;
    byteOffset?: number;
    componentType: number;
    count: number;
    type: string;
    normalized?: boolean;
    sparse?: unknown;
  }[];
  bufferViews?: { buffer: number; byteOffset?: number; byteLength: number; byteStride?: number }[];
  buffers?: { uri?: string; byteLength: number }[];
  extensionsRequired?: string[];
}

const kJson = 0x4e4f534a;
const kMagic = 0x46546c67;
const kWidths: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
// Size of a component in bytes, the function that reads it, and the value that means 1 if normalized.
const kComponents: Record<number, [number, (view: DataView, at: number) => number, number]> = {
  5120: [1, (view, at) => view.getInt8(at), 127],
  5121: [1, (view, at) => view.getUint8(at), 255],
  5122: [2, (view, at) => view.getInt16(at, true), 32767],
  5123: [2, (view, at) => view.getUint16(at, true), 65535],
  5125: [4, (view, at) => view.getUint32(at, true), 4294967295],
  5126: [4, (view, at) => view.getFloat32(at, true), 1],
};
const kKnown =
  /^(KHR_texture_transform|KHR_mesh_quantization|KHR_materials_\w+|KHR_lights_punctual)$/;

export const damaged = (what: string): Refusal => new Refusal(what, 'Export the model again');

export class GltfFile {
  readonly json: GltfJson;
  private readonly buffers: Uint8Array[];

  constructor(bytes: ArrayBuffer) {
    const { text, chunk } = split(bytes);
    try {
      this.json = JSON.parse(text) as GltfJson;
    } catch {
      throw damaged('the file is not valid glTF');
    }
    const strange = (this.json.extensionsRequired ?? []).find((name) => !kKnown.test(name));
    if (strange)
      throw new Refusal(
        `the glTF extension ${strange} is not supported`,
        'Export the model without this extension (usually: without compression)',
      );
    this.buffers = (this.json.buffers ?? []).map((buffer, i) =>
      buffer.uri === undefined && i === 0 && chunk ? chunk : embedded(buffer.uri),
    );
  }

  /** Returns the numbers of an accessor, element by element, and the count of numbers per element. */
  numbers(index: number, name: string): { values: Float64Array; width: number } {
    const accessor = this.json.accessors?.[index];
    const view = this.view(accessor?.bufferView, name);
    const component = kComponents[accessor?.componentType ?? 0];
    const width = kWidths[accessor?.type ?? ''];
    if (!accessor || !component || !width)
      throw damaged(`the model's ${name} have an unknown type`);
    if (accessor.sparse)
      throw new Refusal(
        `the model's ${name} use sparse accessors, which are not supported`,
        'Export the model without sparse accessors, or as OBJ',
      );
    const [size, read, one] = component;
    const stride = view.stride ?? size * width;
    const first = accessor.byteOffset ?? 0;
    const count = accessor.count;
    const end = first + stride * (count - 1) + size * width;
    if (!(count >= 0 && first >= 0 && stride > 0) || (count > 0 && !(end <= view.bytes.byteLength)))
      throw damaged(`the model's ${name} lie outside the file`);
    const data = new DataView(view.bytes.buffer, view.bytes.byteOffset, view.bytes.byteLength);
    const values = new Float64Array(count * width);
    for (let i = 0; i < count; i += 1)
      for (let k = 0; k < width; k += 1)
        values[i * width + k] = read(data, first + i * stride + k * size);
    if (accessor.normalized) values.forEach((value, i) => (values[i] = Math.max(value / one, -1)));
    return { values, width };
  }

  /** Returns an image embedded in the file, or the URI of an external image; undefined if there is none. */
  picture(
    index: number | undefined,
  ): { bytes: Uint8Array; type: string } | { uri: string } | undefined {
    const image = index === undefined ? undefined : this.json.images?.[index];
    if (!image) return undefined;
    const type = image.mimeType ?? /^data:([^;,]+)/.exec(image.uri ?? '')?.[1] ?? 'image/png';
    if (image.bufferView !== undefined)
      return { bytes: this.view(image.bufferView, 'images').bytes, type };
    if (image.uri?.startsWith('data:')) return { bytes: embedded(image.uri), type };
    return image.uri === undefined ? undefined : { uri: unescaped(image.uri) };
  }

  private view(index: number | undefined, name: string): { bytes: Uint8Array; stride?: number } {
    const view = index === undefined ? undefined : this.json.bufferViews?.[index];
    const buffer = view && this.buffers[view.buffer];
    const first = view?.byteOffset ?? 0;
    if (
      !buffer ||
      !(first >= 0 && view.byteLength >= 0 && first + view.byteLength <= buffer.length)
    )
      throw damaged(`the model's ${name} are missing or lie outside the file`);
    const bytes = buffer.subarray(first, first + view.byteLength);
    return view.byteStride === undefined ? { bytes } : { bytes, stride: view.byteStride };
  }
}

/** Splits a file into its JSON and, for a GLB, its binary chunk. */
function split(bytes: ArrayBuffer): { text: string; chunk?: Uint8Array } {
  const view = new DataView(bytes);
  const decode = (part: Uint8Array) => new TextDecoder().decode(part);
  if (bytes.byteLength < 20 || view.getUint32(0, true) !== kMagic)
    return { text: decode(new Uint8Array(bytes)) };
  const length = view.getUint32(12, true);
  if (view.getUint32(16, true) !== kJson || length > bytes.byteLength - 20)
    throw damaged('the file is incomplete or not valid GLB');
  const text = decode(new Uint8Array(bytes, 20, length));
  const next = 20 + length;
  if (next + 8 > bytes.byteLength) return { text };
  const size = view.getUint32(next, true);
  if (size > bytes.byteLength - next - 8) throw damaged('the file is incomplete');
  return { text, chunk: new Uint8Array(bytes, next + 8, size) };
}

function embedded(uri: string | undefined): Uint8Array {
  const data = /^data:[^,]*;base64,(.*)$/s.exec(uri ?? '');
  if (!data)
    throw new Refusal(
      "the model's data are in another file",
      'Export the model as GLB, which is a single file',
    );
  try {
    return Uint8Array.from(atob(data[1]!), (letter) => letter.charCodeAt(0));
  } catch {
    throw damaged('the embedded data are not valid base64');
  }
}

function unescaped(uri: string): string {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
}
