/**
 * The page's view of a model has the colours that are printed. The models are cases of ../shared/cases: spheres of four
 * coloured quadrants. tests/foreign/read/places.py runs the worker on a case and computes, from film.png, which colour is
 * where.
 */
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterAll, expect, test } from 'vitest';
import { bin, root } from './daemon';
import { usePaintPage } from './paint_cases';
import type { Drawing } from './paint_page';
import { rareTest } from './place';

/** Names of cases.py. The first two are in the sample of CI. */
const kRuns = [
  '20-gltf-base-colour-product | texture tinted by vertex colours',
  '24-texture-exif | orientation 6, material',
  '01-obj-vertex-rgba | rgba',
  '03-mtl-texture-options | offset by half, one number',
  '05-names-on-linux | texture differs in case',
  '10-stl-colour | Magics, each facet its colour',
  '14-ply-colour-kinds | float r g b a',
  '17-gltf-texcoord-override | texCoord 0, overridden by 1',
  '18-gltf-specular-glossiness | diffuseTexture',
  '25-texture-colour-space | gAMA 1.0 in a GLB: ignored',
];
const kPixels = 256;

type Colour = [number, number, number];

/** What places.py prints. Points are (x, y) from the middle of the model, which is seen from below. */
interface Places {
  radius_mm: number;
  /** The largest difference of a channel, of 255. */
  levels: number;
  quadrants: { name: string; points_mm: [number, number][]; colour: Colour }[];
}

const folder = mkdtempSync(join(tmpdir(), 'reading-'));
const place = usePaintPage();

afterAll(() => rmSync(folder, { recursive: true, force: true }));

/** Runs the worker. Its results are in the folder. */
function placesOf(name: string): Places {
  const judge = join(root, 'tests/foreign/read/places.py');
  const args = ['-B', judge, join(bin, 'hydroprint-worker'), name, folder];
  return JSON.parse(execFileSync('/usr/bin/python3', args, { encoding: 'utf8' })) as Places;
}

/** The page's view from below. x increases to the left, and y upwards. */
async function fromBelow(half_mm: number): Promise<Buffer> {
  const drawing: Drawing = {
    mesh: readFileSync(join(folder, 'model/model.glb')).toString('base64'),
    pixels: kPixels,
    half_mm,
    direction: [0, 0, 1],
    up: [0, 1, 0],
  };
  const pixels = await place.page.evaluate((asked) => window.drawPaint(asked), drawing);
  return Buffer.from(pixels, 'base64');
}

const median = (values: number[]): number =>
  values.sort((a, b) => a - b)[Math.floor(values.length / 2)]!;

/** The median of each channel and of alpha. */
function colourAt(pixels: Buffer, points_mm: [number, number][], half_mm: number): number[] {
  const starts = points_mm.map(([x, y]) => {
    const [column, row] = [-x, -y].map((at) => Math.floor(((at / half_mm + 1) / 2) * kPixels));
    return 4 * (row! * kPixels + column!);
  });
  return [0, 1, 2, 3].map((channel) => median(starts.map((start) => pixels[start + channel]!)));
}

async function compare(name: string): Promise<void> {
  const { radius_mm, levels, quadrants } = placesOf(name);
  const half_mm = 1.1 * radius_mm;
  const pixels = await fromBelow(half_mm);
  for (const { name: quadrant, points_mm, colour } of quadrants) {
    const shown = colourAt(pixels, points_mm, half_mm);
    const off = [...colour, 255].map((value, channel) => Math.abs(value - shown[channel]!));
    const facts = `${quadrant}: ${shown.join()} on the page, ${colour.join()} on the film`;
    expect(Math.max(...off), facts).toBeLessThanOrEqual(levels);
  }
}

const kHasCases = existsSync(join(root, '../shared/cases'));
kRuns.forEach((name, i) => {
  const run = !kHasCases ? test.skip : i < 2 ? test : rareTest;
  run(`the page shows the colours that are printed: ${name}`, () => compare(name));
});
