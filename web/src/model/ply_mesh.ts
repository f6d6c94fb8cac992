/** Reads a PLY file as a model. */
import type { Mesh, SurfaceMaterial } from './mesh';
import { columnsOf, readPly, texturesOf, trianglesOf, type PlyElement } from './ply';
import { Refusal } from './result';

export function readPlyMesh(bytes: ArrayBuffer): Mesh {
  const elements = readPly(bytes);
  const vertex = elements.get('vertex');
  const positions = vertex && columnsOf(vertex, ['x', 'y', 'z']);
  if (!vertex || !positions)
    throw new Refusal('the file has no vertices with x, y and z', 'Export the model as a mesh');
  const uvs = kUvNames.map((names) => columnsOf(vertex, names)).find((found) => found);
  const colours = columnsOf(vertex, ['red', 'green', 'blue']);
  const indices = trianglesOf(elements);
  const mesh: Mesh = {
    positions,
    indices,
    ...(uvs ? { uvs } : {}),
    ...(colours ? { colours: Uint8Array.from(colours) } : {}),
    parts: [{ material: '', first: 0, count: indices.length }],
    libraries: [],
  };
  const face = elements.get('face')!;
  return withTextures(withFaceUvs(mesh, face), face, texturesOf(bytes));
}

const kUvNames = [
  ['u', 'v'],
  ['s', 't'],
  ['texture_u', 'texture_v'],
  ['tx', 'ty'],
];

const cornersOf = (face: PlyElement) =>
  face.lists.get('vertex_indices') ?? face.lists.get('vertex_index');

/** Uses the faces' own texture coordinates, if there are any. Each corner of a triangle then is a vertex. */
function withFaceUvs(mesh: Mesh, face: PlyElement): Mesh {
  const list = face.lists.get('texcoord');
  if (!list?.lengths.some((length) => length > 0)) return mesh;
  const uvs: number[] = [];
  const take = (at: number) => uvs.push(list.values[at] ?? 0, list.values[at + 1] ?? 0);
  let at = 0;
  cornersOf(face)!.lengths.forEach((corners, i) => {
    const length = list.lengths[i]!;
    const hasUvs = length === 2 * corners;
    for (let k = 2; k < corners; k += 1)
      for (const corner of [0, k - 1, k]) take(hasUvs ? at + 2 * corner : -2);
    at += length;
  });
  return { ...withoutSharing(mesh), uvs: Float32Array.from(uvs) };
}

function withoutSharing(mesh: Mesh): Mesh {
  const { positions, colours, indices } = mesh;
  const spread = (values: ArrayLike<number>, i: number) =>
    values[3 * indices[(i / 3) | 0]! + (i % 3)]!;
  const length = 3 * indices.length;
  return {
    ...mesh,
    positions: Float32Array.from({ length }, (_, i) => spread(positions, i)),
    ...(colours ? { colours: Uint8Array.from({ length }, (_, i) => spread(colours, i)) } : {}),
    indices: Uint32Array.from(indices, (_, i) => i),
  };
}

/** Gives the triangles the materials of their textures; `texnumber` chooses one of several. */
function withTextures(mesh: Mesh, face: PlyElement, textures: readonly string[]): Mesh {
  if (textures.length === 0) return mesh;
  const materials = new Map<string, SurfaceMaterial>();
  const groups = new Map<string, number[]>();
  for (const map of textures) materials.set(map, { colour: [1, 1, 1], map });
  const numbers = face.columns.get('texnumber');
  let first = 0;
  cornersOf(face)!.lengths.forEach((corners, i) => {
    const material = textures[numbers ? numbers[i]! : 0] ?? '';
    const group = groups.get(material) ?? [];
    groups.set(material, group);
    for (let k = 2; k < corners; k += 1, first += 3)
      group.push(...mesh.indices.subarray(first, first + 3));
  });
  const parts: Mesh['parts'] = [];
  for (const [material, { length }] of groups)
    parts.push({
      material,
      first: (parts.at(-1)?.first ?? 0) + (parts.at(-1)?.count ?? 0),
      count: length,
    });
  return { ...mesh, indices: Uint32Array.from([...groups.values()].flat()), parts, materials };
}
