/** The geometry of a painted mesh. */
import { BufferAttribute, BufferGeometry } from 'three';
import type { Mesh } from '../model/mesh';
import type { FineMesh } from './axis_distance';
import { distancesOf } from './shader';

type Parts = Mesh['parts'];

/** The attributes that the paint's materials read, except for the distances. */
export function geometryOf(mesh: Mesh): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(mesh.positions, 3));
  if (mesh.uvs) geometry.setAttribute('uv', new BufferAttribute(mesh.uvs, 2));
  if (mesh.colours) geometry.setAttribute('ownColour', new BufferAttribute(mesh.colours, 3, true));
  geometry.setIndex(new BufferAttribute(mesh.indices, 1));
  mesh.parts.forEach((part, i) => geometry.addGroup(part.first, part.count, i));
  geometry.computeVertexNormals();
  return geometry;
}

/** The same surface with more vertices, and the distances to the axes of the layers. */
export function fineGeometry(coarse: BufferGeometry, fine: FineMesh, parts: Parts): BufferGeometry {
  const geometry = new BufferGeometry();
  for (const [name, attribute] of Object.entries(coarse.attributes))
    geometry.setAttribute(name, extended(attribute as BufferAttribute, fine.parents));
  fine.distances.forEach((distances, i) => {
    if (distances) geometry.setAttribute(distancesOf(i), new BufferAttribute(distances, 3));
  });
  geometry.setIndex(new BufferAttribute(fine.indices, 1));
  parts.forEach(({ first, count }, i) => {
    const [from, to] = [first, first + count].map((at) => 3 * indexOf(fine.sources, at / 3));
    geometry.addGroup(from!, to! - from!, i);
  });
  return geometry;
}

/** The attribute with the means of the parents of new vertices. */
function extended(attribute: BufferAttribute, parents: Uint32Array): BufferAttribute {
  const { array, itemSize, count, normalized } = attribute;
  const size = itemSize * (count + parents.length / 2);
  const out = array instanceof Uint16Array ? new Uint16Array(size) : new Float32Array(size);
  out.set(array);
  for (let i = 0; i < parents.length; i += 2) {
    const [a, b] = [itemSize * parents[i]!, itemSize * parents[i + 1]!];
    const at = itemSize * (count + i / 2);
    for (let k = 0; k < itemSize; k += 1) out[at + k] = (out[a + k]! + out[b + k]!) / 2;
  }
  return new BufferAttribute(out, itemSize, normalized);
}

/** The number of leading elements of a sorted list below `value`. */
function indexOf(sorted: Uint32Array, value: number): number {
  let [low, high] = [0, sorted.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle]! < value) low = middle + 1;
    else high = middle;
  }
  return low;
}
