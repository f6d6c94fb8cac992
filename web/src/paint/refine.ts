/** Subdivides a mesh without cracks: whether an edge is halved depends only on the edge. */

/** A mesh that may grow. */
export interface GrowingMesh {
  /** x, y, z of each vertex. */
  positions: number[];
  indices: Uint32Array;
  /** Per triangle: that of the original mesh. Triangles keep the order of the original mesh. */
  sources: Uint32Array;
  /** The two ends of the edge in whose middle each new vertex is; new vertices come after those of the original mesh. */
  parents: number[];
}

export const growing = (positions: ArrayLike<number>, indices: ArrayLike<number>): GrowingMesh => ({
  positions: Array.from(positions),
  indices: Uint32Array.from(indices),
  sources: Uint32Array.from({ length: indices.length / 3 }, (_, i) => i),
  parents: [],
});

/** Asked with the length of an edge and its middle. */
export type IsLong = (length: number, x: number, y: number, z: number) => boolean;

/**
 * Halves edges for which `isLong` is true until none are left, or the mesh would have more than `most` triangles. Longer
 * edges come first, so that a mesh that would be too large is coarser everywhere.
 * @param finest  least length of an edge that is halved
 */
export function refine(mesh: GrowingMesh, finest: number, isLong: IsLong, most: number): void {
  let least = Math.max(finest, longestEdge(mesh) / 2);
  for (;;) {
    const cuts = cutsOf(mesh, (length, x, y, z) => length > least && isLong(length, x, y, z));
    if (cuts.triangles > most) return;
    if (cuts.triangles > mesh.sources.length) split(mesh, cuts);
    else if (least > finest) least = Math.max(finest, least / 2);
    else return;
  }
}

/** The new vertex of each half-edge, or -1, and the number of triangles after the cuts. */
interface Cuts {
  vertices: Int32Array;
  triangles: number;
}

const lengthOf = (at: number[], a: number, b: number): number =>
  Math.hypot(
    at[3 * a]! - at[3 * b]!,
    at[3 * a + 1]! - at[3 * b + 1]!,
    at[3 * a + 2]! - at[3 * b + 2]!,
  );

/** The end of a half-edge; it starts at vertex `indices[half]`. */
const endOf = (indices: Uint32Array, half: number): number =>
  indices[half % 3 === 2 ? half - 2 : half + 1]!;

function longestEdge({ positions, indices }: GrowingMesh): number {
  let longest = 0;
  for (let half = 0; half < indices.length; half += 1)
    longest = Math.max(longest, lengthOf(positions, indices[half]!, endOf(indices, half)));
  return longest;
}

/** Chooses the edges to halve, and numbers their middles; both triangles at an edge get the same. */
function cutsOf({ positions: at, indices }: GrowingMesh, isLong: IsLong): Cuts {
  const vertices = new Int32Array(indices.length).fill(-1);
  const known = new Map<number, number>();
  const count = at.length / 3;
  let next = count;
  let triangles = indices.length / 3;
  for (let half = 0; half < indices.length; half += 1) {
    const [from, to] = [indices[half]!, endOf(indices, half)];
    const [a, b] = [Math.min(from, to), Math.max(from, to)];
    const middle = (k: number) => (at[3 * a + k]! + at[3 * b + k]!) / 2;
    if (!isLong(lengthOf(at, a, b), middle(0), middle(1), middle(2))) continue;
    const vertex = known.get(a * count + b) ?? next++;
    known.set(a * count + b, vertex);
    vertices[half] = vertex;
    triangles += 1;
  }
  return { vertices, triangles };
}

function split(mesh: GrowingMesh, { vertices, triangles }: Cuts): void {
  const { indices, sources } = mesh;
  addMiddles(mesh, vertices);
  mesh.indices = new Uint32Array(3 * triangles);
  mesh.sources = new Uint32Array(triangles);
  let next = 0;
  for (let t = 0; t < sources.length; t += 1)
    for (const [a, b, c] of pieces(indices, vertices, 3 * t)) {
      mesh.indices.set([a, b, c], 3 * next);
      mesh.sources[next++] = sources[t]!;
    }
}

function addMiddles({ positions: at, indices, parents }: GrowingMesh, vertices: Int32Array): void {
  for (let half = 0; half < vertices.length; half += 1) {
    const vertex = vertices[half]!;
    // The other triangle at the edge has added it, or there was none.
    if (3 * vertex < at.length) continue;
    const [a, b] = [indices[half]!, endOf(indices, half)];
    for (let k = 0; k < 3; k += 1) at.push((at[3 * a + k]! + at[3 * b + k]!) / 2);
    parents.push(a, b);
  }
}

type Triangle = readonly [number, number, number];

/** The pieces of the triangle whose first half-edge is `half`. */
function pieces(indices: Uint32Array, vertices: Int32Array, half: number): Triangle[] {
  const corners = [indices[half]!, indices[half + 1]!, indices[half + 2]!];
  const middles = [vertices[half]!, vertices[half + 1]!, vertices[half + 2]!];
  const cuts = middles.filter((vertex) => vertex >= 0).length;
  if (cuts === 0) return [[corners[0]!, corners[1]!, corners[2]!]];
  // Turned so that the first edge is cut, and with two cuts the last one is not.
  const first = [0, 1, 2].find(
    (i) => middles[i]! >= 0 && (cuts !== 2 || middles[(i + 2) % 3]! < 0),
  )!;
  const turned = (list: number[]) => [0, 1, 2].map((i) => list[(first + i) % 3]!);
  const [a, b, c] = turned(corners) as [number, number, number];
  const [ab, bc, ca] = turned(middles) as [number, number, number];
  if (cuts === 1)
    return [
      [a, ab, c],
      [ab, b, c],
    ];
  if (cuts === 2)
    return [
      [ab, b, bc],
      [a, ab, bc],
      [a, bc, c],
    ];
  return [
    [a, ab, ca],
    [ab, b, bc],
    [ca, bc, c],
    [ab, bc, ca],
  ];
}
