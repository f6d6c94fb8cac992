/** Reads a glTF 2.0 model from one file (GLB, or JSON with embedded data): its geometry in world space and materials. */
import { damaged, GltfFile, type Primitive } from './gltf_file';
import type { Mesh, SurfaceMaterial } from './mesh';

/** Column-major, as in glTF: three axes and the translation. */
type Matrix = readonly number[];
const kIdentity: Matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

const kDeepest = 256;
const kMostNodes = 100_000;
const kMostCorners = 30_000_000;
// glTF lengths are in metres.
const kUnit_mm = 1000;

export function readGltf(bytes: ArrayBuffer): Mesh {
  try {
    const reader = new GltfReader(new GltfFile(bytes));
    for (const root of reader.roots()) reader.visit(root, kIdentity, 0);
    return reader.finish();
  } catch (error) {
    // A value in the JSON has the wrong type.
    if (error instanceof TypeError) throw damaged('the file is not valid glTF');
    throw error;
  }
}

class GltfReader {
  private readonly positions: number[] = [];
  private readonly indices: number[] = [];
  private readonly uvs: number[] = [];
  private readonly colours: number[] = [];
  private readonly parts: Mesh['parts'] = [];
  private readonly materials = new Map<string, SurfaceMaterial>();
  private nodes = 0;
  private hasUvs = false;
  private hasColours = false;

  constructor(private readonly file: GltfFile) {}

  /** Root nodes of the default scene, else of the first scene, else all nodes that are not children. */
  roots(): number[] {
    const { scene, scenes, nodes = [] } = this.file.json;
    const chosen = scenes?.[scene ?? 0]?.nodes;
    if (chosen) return chosen;
    const children = new Set(nodes.flatMap((node) => node.children ?? []));
    return nodes.map((_, i) => i).filter((i) => !children.has(i));
  }

  visit(index: number, parent: Matrix, depth: number): void {
    const node = this.file.json.nodes?.[index];
    this.nodes += 1;
    if (!node) throw damaged(`node ${index} does not exist`);
    if (depth > kDeepest || this.nodes > kMostNodes)
      throw damaged(
        `node ${index} contains itself or is nested more than ${kDeepest} levels deep, or the file has more than ${kMostNodes} nodes`,
      );
    const own = times(parent, node.matrix?.length === 16 ? node.matrix : placed(node));
    if (node.mesh !== undefined) {
      const mesh = this.file.json.meshes?.[node.mesh];
      if (!mesh) throw damaged(`mesh ${node.mesh} does not exist`);
      for (const primitive of mesh.primitives) this.add(primitive, own);
    }
    for (const child of node.children ?? []) this.visit(child, own, depth + 1);
  }

  finish(): Mesh {
    return {
      positions: Float32Array.from(this.positions),
      indices: Uint32Array.from(this.indices),
      ...(this.hasUvs ? { uvs: Float32Array.from(this.uvs) } : {}),
      ...(this.hasColours ? { colours: Uint8Array.from(this.colours) } : {}),
      parts: this.parts,
      libraries: [],
      materials: this.materials,
      unit_mm: kUnit_mm,
    };
  }

  private add(primitive: Primitive, transform: Matrix): void {
    const mode = primitive.mode ?? 4;
    if (mode < 4) return; // points and lines
    const { values, width } = this.numbers(primitive, 'POSITION', 'positions');
    if (width !== 3) throw damaged('the vertex positions do not have three coordinates');
    const first = this.positions.length / 3;
    const count = values.length / 3;
    const order =
      primitive.indices === undefined
        ? Float64Array.from({ length: count }, (_, i) => i)
        : this.file.numbers(primitive.indices, 'indices').values;
    if (this.indices.length + 3 * order.length > kMostCorners)
      throw damaged(
        'the model has too many faces for this browser. Reduce their number in a 3D editor',
      );
    for (let i = 0; i < values.length; i += 3)
      this.positions.push(...moved(transform, values[i]!, values[i + 1]!, values[i + 2]!));
    this.addLook(primitive, count);
    const begin = this.indices.length;
    const isMirrored = determinant(transform) < 0;
    for (const [a, b, c] of triangles(order, mode)) {
      if (Math.max(a, b, c) >= count)
        throw damaged('a face refers to a vertex that does not exist');
      this.indices.push(first + a, first + (isMirrored ? c : b), first + (isMirrored ? b : c));
    }
    const material = this.materialOf(primitive.material);
    this.parts.push({ material, first: begin, count: this.indices.length - begin });
  }

  private numbers(primitive: Primitive, attribute: string, name: string) {
    return this.file.numbers(primitive.attributes[attribute] ?? -1, name);
  }

  private addLook(primitive: Primitive, count: number): void {
    const { materials } = this.file.json;
    const texture = materials?.[primitive.material ?? -1]?.pbrMetallicRoughness?.baseColorTexture;
    const place = `TEXCOORD_${texture?.texCoord ?? 0}`;
    const uvs =
      place in primitive.attributes && this.numbers(primitive, place, 'texture coordinates');
    const tint = 'COLOR_0' in primitive.attributes && this.numbers(primitive, 'COLOR_0', 'colours');
    for (let i = 0; i < count; i += 1) {
      // In glTF, v points downwards.
      if (uvs) this.uvs.push(uvs.values[uvs.width * i]!, 1 - uvs.values[uvs.width * i + 1]!);
      else this.uvs.push(0, 0);
      for (let k = 0; k < 3; k += 1)
        this.colours.push(tint ? 255 * coded(tint.values[tint.width * i + k] ?? 1) : 255);
    }
    this.hasUvs ||= uvs !== false;
    this.hasColours ||= tint !== false;
  }

  /** Returns the name of a material and reads it on first use. A number makes the name unique. */
  private materialOf(index: number | undefined): string {
    const source = this.file.json.materials?.[index ?? -1];
    const name = source ? `${index} ${source.name ?? ''}` : '';
    if (this.materials.has(name)) return name;
    const { baseColorFactor: factor, baseColorTexture } = source?.pbrMetallicRoughness ?? {};
    const [r = 1, g = 1, b = 1] = factor ?? [];
    const texture = this.file.json.textures?.[baseColorTexture?.index ?? -1];
    const picture = this.file.picture(texture?.source);
    this.materials.set(name, {
      colour: source ? [coded(r), coded(g), coded(b)] : [0.85, 0.85, 0.85],
      ...(picture && 'uri' in picture ? { map: picture.uri } : {}),
      ...(picture && 'bytes' in picture ? { picture } : {}),
    });
    return name;
  }
}

function* triangles(order: Float64Array, mode: number): Generator<[number, number, number]> {
  if (mode === 4 && order.length % 3 !== 0)
    throw damaged('the last triangle of a mesh is incomplete');
  for (let i = 0; i + 2 < order.length; i += mode === 4 ? 3 : 1) {
    const [a, b, c] = [order[i]!, order[i + 1]!, order[i + 2]!];
    if (mode === 6) yield [order[0]!, b, c];
    else if (mode === 5 && i % 2 === 1) yield [b, a, c];
    else yield [a, b, c];
  }
}

// Converts linear light to sRGB, both in [0, 1].
function coded(linear: number): number {
  const c = Math.max(0, Math.min(1, linear));
  return c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
}

function times(a: Matrix, b: Matrix): Matrix {
  return Array.from({ length: 16 }, (_, i) => {
    const [row, column] = [i % 4, i - (i % 4)];
    let sum = 0;
    for (let k = 0; k < 4; k += 1) sum += a[4 * k + row]! * b[column + k]!;
    return sum;
  });
}

function placed(node: { translation?: number[]; rotation?: number[]; scale?: number[] }): Matrix {
  const [x, y, z, w] = unit(node.rotation ?? [0, 0, 0, 1]);
  const [sx = 1, sy = 1, sz = 1] = node.scale ?? [];
  const [tx = 0, ty = 0, tz = 0] = node.translation ?? [];
  return [
    ...[1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)].map((v) => v * sx), 0,
    ...[2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)].map((v) => v * sy), 0,
    ...[2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)].map((v) => v * sz), 0,
    tx, ty, tz, 1,
  ]; // prettier-ignore
}

function unit(q: readonly number[]): [number, number, number, number] {
  const [x = 0, y = 0, z = 0, w = 1] = q;
  const length = Math.hypot(x, y, z, w);
  return length > 0 ? [x / length, y / length, z / length, w / length] : [0, 0, 0, 1];
}

const moved = (m: Matrix, x: number, y: number, z: number): [number, number, number] => [
  m[0]! * x + m[4]! * y + m[8]! * z + m[12]!,
  m[1]! * x + m[5]! * y + m[9]! * z + m[13]!,
  m[2]! * x + m[6]! * y + m[10]! * z + m[14]!,
];

const determinant = (m: Matrix): number =>
  m[0]! * (m[5]! * m[10]! - m[6]! * m[9]!) -
  m[4]! * (m[1]! * m[10]! - m[2]! * m[9]!) +
  m[8]! * (m[1]! * m[6]! - m[2]! * m[5]!);
