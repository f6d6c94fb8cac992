/** Finds the distance from a point to the nearest of many segments. */

const kLeaf = 4;
const kDeepest = 64;

/** A tree of bounding boxes. */
export class SegmentTree {
  /** Of the segments: x, y, z of both ends. */
  private readonly ends: Float64Array;
  /** Of the nodes: the box (low x, y, z, high x, y, z). */
  private readonly boxes: number[] = [];
  /** Of the nodes: the first child, the second is next to it (`count` 0); or the first segment of a leaf. */
  private readonly first: number[] = [];
  private readonly count: number[] = [];
  private readonly stack = new Int32Array(kDeepest);

  /** @param ends  x, y, z of both ends of each segment */
  constructor(ends: Float64Array) {
    const order = Array.from({ length: ends.length / 6 }, (_, i) => i);
    this.ends = new Float64Array(ends.length);
    if (order.length > 0) this.build(ends, order);
  }

  get isEmpty(): boolean {
    return this.ends.length === 0;
  }

  /** Distance to the nearest segment; `most` if none is closer. */
  distance(x: number, y: number, z: number, most: number): number {
    if (this.isEmpty) return most;
    let best = most * most;
    let top = 0;
    this.stack[top++] = 0;
    while (top > 0) {
      const node = this.stack[--top]!;
      if (this.toBox(node, x, y, z) >= best) continue;
      const [at, count] = [this.first[node]!, this.count[node]!];
      for (let i = at; i < at + count; i += 1) best = Math.min(best, this.toSegment(i, x, y, z));
      if (count > 0) continue;
      // The nearer child is visited first.
      const isFirstNearer = this.toBox(at, x, y, z) < this.toBox(at + 1, x, y, z);
      this.stack[top++] = isFirstNearer ? at + 1 : at;
      this.stack[top++] = isFirstNearer ? at : at + 1;
    }
    return Math.sqrt(best);
  }

  private build(ends: Float64Array, order: number[]): void {
    const middle = (segment: number, axis: number) =>
      ends[6 * segment + axis]! + ends[6 * segment + 3 + axis]!;
    const ranges: [node: number, from: number, to: number][] = [[0, 0, order.length]];
    this.add(ends, order);
    for (let next = ranges.pop(); next; next = ranges.pop()) {
      const [node, from, to] = next;
      this.first[node] = from;
      this.count[node] = to - from;
      if (to - from <= kLeaf) continue;
      const axis = this.longestAxis(node);
      const sorted = order.slice(from, to).sort((a, b) => middle(a, axis) - middle(b, axis));
      sorted.forEach((segment, i) => (order[from + i] = segment));
      const half = from + (sorted.length >> 1);
      this.first[node] = this.first.length;
      this.count[node] = 0;
      ranges.push([this.add(ends, order.slice(from, half)), from, half]);
      ranges.push([this.add(ends, order.slice(half, to)), half, to]);
    }
    order.forEach((segment, i) =>
      this.ends.set(ends.subarray(6 * segment, 6 * segment + 6), 6 * i),
    );
  }

  /** Adds a node with the box of some segments. */
  private add(ends: Float64Array, segments: number[]): number {
    const [low, high] = [
      [Infinity, Infinity, Infinity],
      [-Infinity, -Infinity, -Infinity],
    ];
    for (const segment of segments)
      for (let k = 0; k < 6; k += 1) {
        const value = ends[6 * segment + k]!;
        if (value < low[k % 3]!) low[k % 3] = value;
        if (value > high[k % 3]!) high[k % 3] = value;
      }
    this.boxes.push(...low, ...high);
    this.count.push(0);
    return this.first.push(0) - 1;
  }

  private longestAxis(node: number): number {
    const side = (axis: number) => this.boxes[6 * node + 3 + axis]! - this.boxes[6 * node + axis]!;
    if (side(0) >= side(1) && side(0) >= side(2)) return 0;
    return side(1) >= side(2) ? 1 : 2;
  }

  /** Square of the distance to the box of a node. */
  private toBox(node: number, x: number, y: number, z: number): number {
    const box = this.boxes;
    const i = 6 * node;
    const dx = Math.max(box[i]! - x, 0, x - box[i + 3]!);
    const dy = Math.max(box[i + 1]! - y, 0, y - box[i + 4]!);
    const dz = Math.max(box[i + 2]! - z, 0, z - box[i + 5]!);
    return dx * dx + dy * dy + dz * dz;
  }

  /** Square of the distance to a segment. */
  private toSegment(segment: number, x: number, y: number, z: number): number {
    const ends = this.ends;
    const i = 6 * segment;
    const [ax, ay, az] = [ends[i]!, ends[i + 1]!, ends[i + 2]!];
    const [bx, by, bz] = [ends[i + 3]! - ax, ends[i + 4]! - ay, ends[i + 5]! - az];
    const [px, py, pz] = [x - ax, y - ay, z - az];
    const length = bx * bx + by * by + bz * bz;
    const along = length > 0 ? (px * bx + py * by + pz * bz) / length : 0;
    const t = Math.max(0, Math.min(1, along));
    const [dx, dy, dz] = [px - t * bx, py - t * by, pz - t * bz];
    return dx * dx + dy * dy + dz * dz;
  }
}
