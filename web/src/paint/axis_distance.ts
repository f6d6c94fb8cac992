/**
 * Distances to where a surface is projected along each of the three axes of a 'box' layer; same as axis_distance.cpp of
 * the worker. Between vertices the distances are interpolated, so the mesh is first subdivided where axes blend.
 */
import {
  axesAtVertices,
  axisOfTriangles,
  endsOfAxes,
  weld,
  type Axes,
  type Surface,
} from './axis_edges';
import { growing, refine, type GrowingMesh } from './refine';
import { SegmentTree } from './segment_tree';

/** A layer that blends between its axes. */
export interface BoxLayer {
  axes: Axes;
  blend_mm: number;
}

/** A subdivided mesh, and the distances of its vertices to the axes. */
export interface FineMesh {
  indices: Uint32Array;
  /** Per triangle: that of the original mesh. Triangles keep the order of the original mesh. */
  sources: Uint32Array;
  /** The two ends of the edge in whose middle each new vertex is; new vertices come after those of the original mesh. */
  parents: Uint32Array;
  /** Per layer: three distances of each vertex, mm; undefined for layers without. */
  distances: (Float32Array | undefined)[];
}

/** Where axes blend, edges have at most this share of the blend's width. */
const kEdgePerBlend = 1 / 6;
/** Distances are stored up to this multiple of the blend's width. */
const kFurthest = 2;
const kMostTriangles = 400_000;
/** Any point of a triangle is within this multiple of its longest edge from the middle of that edge. */
const kReach = 0.87;

/** The axes of a layer on the original mesh. */
interface Division {
  box: BoxLayer;
  axisOf: Uint8Array;
  /** Sets of axes of the triangles at each vertex. */
  sets: Uint8Array;
  /** The edges at which triangles of each axis meet others, and all of them. */
  ends: SegmentTree[];
  allEnds: SegmentTree;
}

function divide(surface: Surface, welded: Uint32Array, box: BoxLayer): Division {
  const axisOf = axisOfTriangles(surface, box.axes);
  const ends = endsOfAxes(surface, welded, axisOf);
  const all = new Float64Array(ends[0].length + ends[1].length + ends[2].length);
  all.set(ends[0]);
  all.set(ends[1], ends[0].length);
  all.set(ends[2], ends[0].length + ends[1].length);
  return {
    box,
    axisOf,
    sets: axesAtVertices(surface.indices, welded, axisOf),
    ends: ends.map((some) => new SegmentTree(some)),
    allEnds: new SegmentTree(all),
  };
}

/** Subdivides a mesh where axes blend, and computes the distances of its vertices to the axes of each layer. */
export function axisDistances(
  surface: Surface,
  boxes: readonly (BoxLayer | undefined)[],
  mostTriangles = kMostTriangles,
): FineMesh {
  const welded = weld(surface.positions);
  const divisions = boxes.map((box) => box && divide(surface, welded, box));
  const some = divisions.flatMap((division) => division ?? []);
  const mesh = growing(surface.positions, surface.indices);
  const finest = kEdgePerBlend * Math.min(...some.map(({ box }) => box.blend_mm));
  refine(
    mesh,
    finest,
    (length, x, y, z) => some.some((division) => isTooLong(division, length, x, y, z)),
    mostTriangles,
  );
  return {
    indices: mesh.indices,
    sources: mesh.sources,
    parents: Uint32Array.from(mesh.parents),
    distances: divisions.map((division) => division && distancesTo(division, mesh)),
  };
}

function isTooLong(
  { box, allEnds }: Division,
  length: number,
  x: number,
  y: number,
  z: number,
): boolean {
  if (length <= kEdgePerBlend * box.blend_mm) return false;
  const reach = box.blend_mm + kReach * length;
  return allEnds.distance(x, y, z, reach) < reach;
}

function distancesTo(division: Division, mesh: GrowingMesh): Float32Array {
  const { box, ends } = division;
  const at = mesh.positions;
  const most = kFurthest * box.blend_mm;
  const sets = setsOfAll(division, mesh);
  const out = new Float32Array(at.length);
  for (let i = 0; i < at.length; i += 3)
    for (let axis = 0; axis < 3; axis += 1)
      if (((sets[i / 3]! >> axis) & 1) === 0)
        out[i + axis] = ends[axis]!.distance(at[i]!, at[i + 1]!, at[i + 2]!, most);
  return out;
}

/** The sets of axes of all vertices. New ones may lack axes of triangles at copies of them, to which their distance is 0. */
function setsOfAll({ sets, axisOf }: Division, { positions, indices, sources }: GrowingMesh) {
  const out = new Uint8Array(positions.length / 3);
  out.set(sets);
  for (let i = 0; i < indices.length; i += 1)
    out[indices[i]!]! |= 1 << axisOf[sources[Math.floor(i / 3)]!]!;
  return out;
}
