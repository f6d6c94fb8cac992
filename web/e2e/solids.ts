/** Solids as files. */

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

/** A ring with ripples, 162 mm wide, of 1,000,000 triangles: 50 MB. */
export function fineRing(): Buffer {
  const [around, across] = [1000, 500];
  const points = Array.from({ length: around * across }, (_, i): Point => {
    const [a, b] = [
      (2 * Math.PI * Math.floor(i / across)) / around,
      (2 * Math.PI * (i % across)) / across,
    ];
    const tube = 20 + 2 * Math.sin(8 * a) * Math.cos(5 * b);
    const out = 60 + tube * Math.cos(b);
    return [out * Math.cos(a), out * Math.sin(a), tube * Math.sin(b)];
  });
  const at = (i: number, j: number) => points[(i % around) * across + (j % across)]!;
  const triangles: Triangle[] = [];
  for (let i = 0; i < around; i += 1)
    for (let j = 0; j < across; j += 1)
      triangles.push(...square(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)));
  return stlOf(triangles);
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

const kAround = 64;
const kDown = 32;

/** A point of a ball around (5, -4, 30). */
function onBall(i: number, j: number, radius_mm = 25): Point {
  const [a, b] = [(2 * Math.PI * (i % kAround)) / kAround, (Math.PI * j) / kDown];
  const r = j === 0 || j === kDown ? 0 : Math.sin(b);
  const r_mm = r * radius_mm;
  return [5 + r_mm * Math.cos(a), -4 + r_mm * Math.sin(a), 30 + radius_mm * Math.cos(b)];
}

/** The corners of the triangles of a ball: the arguments of onBall(). */
function cornersOfBall(): (readonly [number, number])[][] {
  const out: (readonly [number, number])[][] = [];
  for (let j = 0; j < kDown; j += 1)
    for (let i = 0; i < kAround; i += 1) {
      const [a, b, c, d] = [
        [i, j] as const,
        [i, j + 1] as const,
        [i + 1, j + 1] as const,
        [i + 1, j] as const,
      ];
      if (j < kDown - 1) out.push([a, b, c]);
      if (j > 0) out.push([a, c, d]);
    }
  return out;
}

/** A ball as STL. */
export function ball(radius_mm = 25): Buffer {
  const triangleOf = (corners: (readonly [number, number])[]) =>
    corners.map(([i, j]) => onBall(i, j, radius_mm)) as unknown as Triangle;
  return stlOf(cornersOfBall().map(triangleOf));
}

/** All points of a ball, with those at the seam twice. */
const pointsOfBall = (): (readonly [number, number])[] =>
  Array.from({ length: (kAround + 1) * (kDown + 1) }, (_, k) => [
    k % (kAround + 1),
    Math.floor(k / (kAround + 1)),
  ]);
const indexOf = ([i, j]: readonly [number, number]): number => j * (kAround + 1) + i;

/** A ball as OBJ, with texture coordinates. */
export function ballWithUvs(): Buffer {
  const points = pointsOfBall();
  const corner = (at: readonly [number, number]) => `${indexOf(at) + 1}/${indexOf(at) + 1}`;
  return Buffer.from(
    [
      ...points.map(([i, j]) => `v ${onBall(i, j).join(' ')}`),
      ...points.map(([i, j]) => `vt ${(2 * i) / kAround} ${1 - j / kDown}`),
      ...cornersOfBall().map((corners) => `f ${corners.map(corner).join(' ')}`),
      '',
    ].join('\n'),
  );
}

/** A ball as PLY, with colours of its vertices. */
export function ballWithColours(): Buffer {
  const points = pointsOfBall();
  const triangles = cornersOfBall();
  const properties = [...'xyz'].map((name) => `property float ${name}`);
  const colours = ['red', 'green', 'blue'].map((name) => `property uchar ${name}`);
  const header = ['ply', 'format ascii 1.0', `element vertex ${points.length}`, ...properties];
  const wave = (turns: number) => Math.round(128 + 120 * Math.sin(2 * Math.PI * turns));
  return Buffer.from(
    [
      ...[...header, ...colours, `element face ${triangles.length}`],
      ...['property list uchar int vertex_indices', 'end_header'],
      ...points.map(([i, j]) =>
        [...onBall(i, j), wave(i / kAround), wave(j / kDown), wave((2 * i) / kAround)].join(' '),
      ),
      ...triangles.map((corners) => `3 ${corners.map(indexOf).join(' ')}`),
      '',
    ].join('\n'),
  );
}

/** A triangle as STL in ASCII. */
export const leaf = (): Buffer =>
  Buffer.from(
    [
      ...['solid leaf', 'facet normal 0 0 0', 'outer loop'],
      ...['vertex 0 0 0', 'vertex 30 0 0', 'vertex 0 30 9'],
      ...['endloop', 'endfacet', 'endsolid leaf', ''],
    ].join('\n'),
  );

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
