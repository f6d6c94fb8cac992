/** Solids as STL files. */

type Point = readonly [number, number, number];
type Triangle = readonly [Point, Point, Point];

function stlOf(triangles: Triangle[]): Buffer {
  const out = Buffer.alloc(84 + 50 * triangles.length);
  out.writeUInt32LE(triangles.length, 80);
  triangles.forEach((triangle, i) =>
    triangle.flat().forEach((value, k) => out.writeFloatLE(value, 84 + 50 * i + 12 + 4 * k)),
  );
  return out;
}

/** The two triangles of a square with corners a, b, c, d, counter-clockwise from outside. */
const square = (a: Point, b: Point, c: Point, d: Point): Triangle[] => [
  [a, b, c],
  [a, c, d],
];

/** The walls of a tube through rings of points, counter-clockwise as seen from the tube's end; closed at both ends. */
function tubeOf(rings: Point[][]): Triangle[] {
  const size = rings[0]!.length;
  const walls = rings.slice(1).flatMap((ring, i) =>
    ring.flatMap((_, k) => {
      const [from, next] = [rings[i]!, (k + 1) % size];
      return square(from[k]!, from[next]!, ring[next]!, ring[k]!);
    }),
  );
  // All corners must be seen from the first.
  const lid = (ring: Point[]): Triangle[] =>
    ring.slice(2).map((_, k) => [ring[0]!, ring[k + 1]!, ring[k + 2]!]);
  const [first, ...others] = rings[0]!;
  return [...walls, ...lid(rings.at(-1)!), ...lid([first!, ...others.reverse()])];
}

/** An L of 50 x 30 x 40 mm with legs of 12 mm. */
export function bracket(): Buffer {
  // The inner corner is first, because all others are seen from it.
  const outline = [
    [-8, 2],
    [-8, 30],
    [-20, 30],
    [-20, -10],
    [30, -10],
    [30, 2],
  ] as const;
  const ring = (y: number) => outline.map(([x, z]): Point => [x, y, z]);
  return stlOf(tubeOf([ring(15), ring(-15)]));
}

/** A ball of radius 25 mm around (5, -4, 30). */
export function ball(): Buffer {
  const [around, down] = [64, 32];
  const at = (i: number, j: number): Point => {
    const [a, b] = [(2 * Math.PI * (i % around)) / around, (Math.PI * j) / down];
    const r = j === 0 || j === down ? 0 : Math.sin(b);
    return [5 + 25 * r * Math.cos(a), -4 + 25 * r * Math.sin(a), 30 + 25 * Math.cos(b)];
  };
  const out: Triangle[] = [];
  for (let j = 0; j < down; j += 1)
    for (let i = 0; i < around; i += 1) {
      if (j < down - 1) out.push([at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
      if (j > 0) out.push([at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
    }
  return stlOf(out);
}

/** A tube of radius 9 mm, bent by a third of a turn around a radius of 32 mm. */
export function bentTube(): Buffer {
  const [around, along] = [40, 48];
  const rings = Array.from({ length: along + 1 }, (_, j) => {
    const bend = (2 * Math.PI * j) / along / 3;
    return Array.from({ length: around }, (_, i): Point => {
      const angle = (2 * Math.PI * i) / around;
      const r = 32 + 9 * Math.cos(angle);
      return [r * Math.cos(bend), 9 * Math.sin(angle), r * Math.sin(bend)];
    });
  });
  return stlOf(tubeOf(rings));
}
