/** Compares what the page's shader draws with what the worker computes. */
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { beforeAll, expect, test } from 'vitest';
import type { Vec3 } from '../src/model/pose';
import { layerSpec } from '../src/paint/layer';
import { bin, root } from './daemon';
import {
  kCases,
  kColourCases,
  kUvCases,
  pictures,
  usePaintPage,
  type Case,
  type PictureName,
} from './paint_cases';
import type { Drawing } from './paint_page';
import { rareTest } from './place';
import { pngOf } from './png';
import { ball, ballWithColours, ballWithUvs, bentTube, bracket } from './solids';

const kPixels = 256;
const kHalf_mm = 40;
const kSolids = {
  'bracket.stl': bracket,
  'ball.stl': ball,
  'tube.stl': bentTube,
  'uvs.obj': ballWithUvs,
  'colours.ply': ballWithColours,
};
type SolidName = keyof typeof kSolids;
/** From the front and above, and from behind and below, where cylinders have their seam. */
const kViews: { name: string; direction: Vec3; up: Vec3 }[] = [
  { name: 'front', direction: [-0.5, 1, -0.6], up: [0, 0, 1] },
  { name: 'back', direction: [0.3, -1, 0.4], up: [0, 0, 1] },
];

const folder = mkdtempSync(join(tmpdir(), 'paint-'));
const files = pictures();
const place = usePaintPage();

beforeAll(() => {
  for (const [name, bytes] of Object.entries(files)) writeFileSync(join(folder, name), bytes);
  for (const [name, solid] of Object.entries(kSolids)) writeFileSync(join(folder, name), solid());
});

type View = (typeof kViews)[number];

/** The solid as the worker shows it. */
const glbs = new Map<SolidName, string>();
function glbOf(solid: SolidName): string {
  const out = join(folder, `${solid}-shown`);
  if (!glbs.has(solid)) {
    const args = ['inspect', '--mesh', join(folder, solid), '--out', out];
    execFileSync(join(bin, 'hydroprint-worker'), args);
    glbs.set(solid, readFileSync(join(out, 'model.glb')).toString('base64'));
  }
  return glbs.get(solid)!;
}

async function byPage(solid: SolidName, { base_colour, layers }: Case, view: View) {
  const base64 = (name: PictureName) => files[name].toString('base64');
  const drawing: Drawing = {
    mesh: glbOf(solid),
    layers: layers.map(({ picture, ...rest }) => ({
      ...rest,
      ...(picture ? { picture: base64(picture) } : {}),
    })),
    ...(base_colour ? { base_colour } : {}),
    pixels: kPixels,
    half_mm: kHalf_mm,
    direction: view.direction,
    up: view.up,
  };
  const pixels = await place.page.evaluate((asked) => window.drawPaint(asked), drawing);
  return Buffer.from(pixels, 'base64');
}

async function byWorker(solid: SolidName, { base_colour, layers }: Case, view: View) {
  const [paint, out] = [join(folder, 'paint.json'), join(folder, 'out.png')];
  const spec = {
    baseColour: base_colour,
    layers: layers.map(({ layer, picture, colour }) => ({ ...layerSpec(layer), picture, colour })),
  };
  writeFileSync(paint, JSON.stringify(spec));
  execFileSync(join(bin, 'hydroprint-draw-paint'), [
    ...['--mesh', join(folder, solid), '--paint', paint, '--out', out],
    ...['--pixels', String(kPixels), '--half-mm', String(kHalf_mm)],
    `--direction=${view.direction.join()}`,
    `--up=${view.up.join()}`,
  ]);
  const png = readFileSync(out).toString('base64');
  return Buffer.from(await place.page.evaluate((bytes) => window.readPng(bytes), png), 'base64');
}

/** Whether a pixel and those around it are covered in both pictures. */
function isInside(a: Buffer, b: Buffer, x: number, y: number): boolean {
  for (let j = y - 1; j <= y + 1; j += 1)
    for (let i = x - 1; i <= x + 1; i += 1) {
      if (i < 0 || j < 0 || i >= kPixels || j >= kPixels) return false;
      const alpha = 4 * (j * kPixels + i) + 3;
      if (a[alpha] !== 255 || b[alpha] !== 255) return false;
    }
  return true;
}

/** The differences of the colours of pixels, sorted: the largest of red, green and blue, of 255. */
function differences(a: Buffer, b: Buffer): number[] {
  const out: number[] = [];
  for (let y = 0; y < kPixels; y += 1)
    for (let x = 0; x < kPixels; x += 1) {
      if (!isInside(a, b, x, y)) continue;
      const at = 4 * (y * kPixels + x);
      out.push(Math.max(...[0, 1, 2].map((c) => Math.abs(a[at + c]! - b[at + c]!))));
    }
  return out.sort((p, q) => p - q);
}

/** Saves both pictures and their difference, side by side. */
function save(name: string, a: Buffer, b: Buffer): string {
  const out = join(root, 'build/tests/paint');
  mkdirSync(out, { recursive: true });
  const path = join(out, `${name}.png`);
  const png = pngOf(3 * kPixels, kPixels, (x, y) => {
    const at = 4 * (y * kPixels + (x % kPixels));
    if (x < 2 * kPixels) return [...(x < kPixels ? a : b).subarray(at, at + 4)];
    return [0, 1, 2, 3].map((c) =>
      c < 3 ? Math.min(255, 20 * Math.abs(a[at + c]! - b[at + c]!)) : 255,
    );
  });
  writeFileSync(path, png);
  return path;
}

async function compare(solid: SolidName, paint: Case, view: View): Promise<void> {
  const [mine, theirs] = [await byPage(solid, paint, view), await byWorker(solid, paint, view)];
  const found = differences(mine, theirs);
  const mean = found.reduce((sum, value) => sum + value, 0) / found.length;
  const [most, nearlyAll] = [0.99, 0.999].map((share) => found[Math.floor(share * found.length)]!);
  const name = `${solid}-${paint.name}-${view.name}`;
  const facts = `${name}: ${found.length} pixels, mean ${mean.toFixed(3)}, 99 % ${most}, 99.9 % ${nearlyAll}`;
  const isGood = found.length > 2000 && mean < 1 && most! <= 4 && nearlyAll! <= 12;
  expect(isGood, isGood ? facts : `${facts}; ${save(name, mine, theirs)}`).toBe(true);
}

const one = (name: string) => kCases.find((paint) => paint.name === name)!;

test('the page draws a paint as the worker computes it', async () => {
  await compare('bracket.stl', one('layers'), kViews[0]!);
  await compare('tube.stl', one('cylindrical-turned'), kViews[1]!);
  await compare('uvs.obj', kUvCases[1]!, kViews[0]!);
});

const kRuns: [SolidName[], Case[]][] = [
  [['bracket.stl', 'ball.stl', 'tube.stl'], kCases],
  [['uvs.obj'], kUvCases],
  [['colours.ply'], kColourCases],
];
for (const [solids, paints] of kRuns)
  for (const solid of solids)
    for (const paint of paints)
      rareTest(`the page draws ${paint.name} on ${solid} as the worker computes it`, async () => {
        for (const view of kViews) await compare(solid, paint, view);
      });
