/** Paints for paint.e2e.ts, and the page that draws them. */
import { fileURLToPath } from 'node:url';
import type { Browser, Page } from 'playwright-core';
import { createServer, type ViteDevServer } from 'vite';
import { afterAll, beforeAll } from 'vitest';
import type { Vec3 } from '../src/model/pose';
import type { PaintLayer } from '../src/paint/layer';
import { launch } from './browser';
import { pngOf } from './png';

export interface Case {
  name: string;
  base_colour?: string;
  layers: { layer: PaintLayer; picture?: PictureName; colour?: string }[];
}

/** Waves that fit at the edges, so that the pictures may repeat. */
const wave = (turns: number): number => 0.5 + 0.45 * Math.sin(2 * Math.PI * turns);
const byte = (value: number): number => Math.round(255 * value);

const kPictures = {
  'wide.png': () =>
    pngOf(480, 320, (x, y) => {
      const [u, v] = [x / 480, y / 320];
      return [byte(wave(u + v)), byte(wave(2 * u - v)), byte(wave(2 * v + 0.2))];
    }),
  'tall.png': () =>
    pngOf(240, 400, (x, y) => {
      const [u, v] = [x / 240, y / 400];
      return [byte(wave(v + 0.3)), byte(wave(u + 0.6)), byte(wave(u - 2 * v))];
    }),
  'glass.png': () =>
    pngOf(300, 300, (x, y) => {
      const [u, v] = [x / 300, y / 300];
      return [byte(wave(u)), byte(wave(v)), byte(wave(u + v)), byte(wave(u - v + 0.1))];
    }),
};
export type PictureName = keyof typeof kPictures;

/** The pictures as PNG files. */
export const pictures = (): Record<PictureName, Buffer> => ({
  'wide.png': kPictures['wide.png'](),
  'tall.png': kPictures['tall.png'](),
  'glass.png': kPictures['glass.png'](),
});

const kSlanted: Vec3 = [0.4, 1, -0.3];

export const kCases: Case[] = [
  { name: 'planar', layers: [{ layer: { projection: 'planar' }, picture: 'wide.png' }] },
  {
    name: 'planar-slanted',
    layers: [
      {
        layer: {
          projection: 'planar',
          direction: [-0.4, 1, 0.7],
          size_mm: 28,
          turn_deg: 200,
          mirror: true,
          repeat: true,
        },
        picture: 'tall.png',
      },
    ],
  },
  {
    name: 'dip',
    base_colour: '#1f4fa8',
    layers: [
      { layer: { projection: 'dip', up: [0.9, 0.4, 0.3], opacity: 0.6 }, picture: 'wide.png' },
    ],
  },
  { name: 'cylindrical', layers: [{ layer: { projection: 'cylindrical' }, picture: 'wide.png' }] },
  {
    name: 'cylindrical-turned',
    layers: [
      {
        layer: {
          projection: 'cylindrical',
          direction: [1, 0.2, 0.3],
          up: [0, 1, 0],
          size_mm: 40,
          turn_deg: 100,
          mirror: true,
        },
        picture: 'tall.png',
      },
    ],
  },
  {
    name: 'cylindrical-once',
    layers: [
      {
        layer: { projection: 'cylindrical', repeat: false, size_mm: 90, position_mm: [2, 1, 3] },
        picture: 'wide.png',
      },
    ],
  },
  { name: 'box', layers: [{ layer: { projection: 'box' }, picture: 'wide.png' }] },
  {
    name: 'box-slanted',
    base_colour: '#f0e020',
    layers: [
      {
        layer: {
          projection: 'box',
          direction: kSlanted,
          up: [-0.1, 0.1, 1],
          size_mm: 25,
          turn_deg: -20,
          blend_mm: 9,
          opacity: 0.7,
        },
        picture: 'tall.png',
      },
    ],
  },
  {
    name: 'decal',
    base_colour: '#30a050',
    layers: [
      {
        layer: { projection: 'decal', direction: kSlanted, turn_deg: 30, depth_mm: 40 },
        picture: 'glass.png',
      },
    ],
  },
  {
    name: 'layers',
    base_colour: '#808080',
    layers: [
      { layer: { projection: 'box', size_mm: 40, blend_mm: 6 }, picture: 'glass.png' },
      { layer: { projection: 'decal', direction: [0, 1, 0], size_mm: 20 }, colour: '#c02010' },
      { layer: { projection: 'cylindrical', opacity: 0.5 }, picture: 'glass.png' },
      { layer: { projection: 'decal', direction: [1, 0, 0], size_mm: 30 }, picture: 'tall.png' },
    ],
  },
];

/** Paints for a mesh with texture coordinates. */
export const kUvCases: Case[] = [
  {
    name: 'uv',
    base_colour: '#30a050',
    layers: [{ layer: { projection: 'uv', opacity: 0.8 }, picture: 'glass.png' }],
  },
  {
    name: 'uv-once',
    layers: [
      { layer: { projection: 'uv', repeat: false }, picture: 'wide.png' },
      { layer: { projection: 'decal', direction: kSlanted, size_mm: 25 }, picture: 'glass.png' },
    ],
  },
  { name: 'box-over-uv', layers: [{ layer: { projection: 'box' }, picture: 'wide.png' }] },
];

/** Paints for a mesh with colours of its vertices. */
export const kColourCases: Case[] = [
  {
    name: 'vertex-colours',
    layers: [
      { layer: { projection: 'vertex_colors' } },
      { layer: { projection: 'planar', direction: kSlanted, size_mm: 30 }, picture: 'glass.png' },
    ],
  },
];

/** Opens paint_page.html for the tests of a file. */
export function usePaintPage(): { page: Page } {
  const place = {} as { page: Page };
  let server: ViteDevServer;
  let browser: Browser;
  beforeAll(async () => {
    server = await createServer({
      root: fileURLToPath(new URL('..', import.meta.url)),
      logLevel: 'error',
      server: { port: 0, host: '127.0.0.1' },
      // Vite reloads a page when it finds a package that it has not prepared, as those that are imported late.
      optimizeDeps: { include: ['three', 'three/addons/loaders/GLTFLoader.js'] },
    });
    await server.listen();
    browser = await launch();
    place.page = await browser.newPage();
    place.page.on('pageerror', (error) => console.error(error));
    place.page.on('console', (message) => {
      const isOfPage = message.location().url.includes('/e2e/') || message.text().includes('THREE');
      if (message.type() === 'error' && isOfPage) console.error(message.text());
    });
    await place.page.goto(`${server.resolvedUrls!.local[0]}e2e/paint_page.html`);
    await place.page.waitForFunction(() => 'drawPaint' in window);
  });
  afterAll(async () => {
    await browser?.close();
    await server?.close();
  });
  return place;
}
