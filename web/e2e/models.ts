import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Locator, Page } from 'playwright-core';
import { pngOf } from './png';

/** Writes a ball of radius 1 (in units of the file) with a striped texture: ball.obj, ball.mtl, ball.png. */
export function makeBall(folder: string): { obj: string; mtl: string; png: string } {
  const [around, down] = [24, 12];
  const lines = ['mtllib ball.mtl', 'usemtl paint'];
  for (let j = 0; j <= down; j += 1)
    for (let i = 0; i <= around; i += 1) {
      const [a, b] = [(2 * Math.PI * i) / around, (Math.PI * j) / down];
      const place = [Math.sin(b) * Math.cos(a), Math.sin(b) * Math.sin(a), Math.cos(b)];
      lines.push(`v ${place.map((x) => x.toFixed(9)).join(' ')}`);
      lines.push(`vt ${(i / around).toFixed(6)} ${(1 - j / down).toFixed(6)}`);
    }
  const at = (i: number, j: number) => j * (around + 1) + i + 1;
  for (let j = 0; j < down; j += 1)
    for (let i = 0; i < around; i += 1) {
      const [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
      if (j < down - 1) lines.push(`f ${a}/${a} ${b}/${b} ${c}/${c}`);
      if (j > 0) lines.push(`f ${a}/${a} ${c}/${c} ${d}/${d}`);
    }
  const [obj, mtl, png] = ['obj', 'mtl', 'png'].map((ending) => join(folder, `ball.${ending}`));
  writeFileSync(obj!, `${lines.join('\n')}\n`);
  writeFileSync(mtl!, 'newmtl paint\nmap_Kd ball.png\n');
  writeFileSync(png!, stripes(64));
  return { obj: obj!, mtl: mtl!, png: png! };
}

/** The same ball with a diameter of 60 mm, as a GLB with embedded texture. */
export function ballGlb(): Buffer {
  const [around, down] = [24, 12];
  const positions: number[] = [];
  const uvs: number[] = [];
  const corners: number[] = [];
  for (let j = 0; j <= down; j += 1)
    for (let i = 0; i <= around; i += 1) {
      const [a, b] = [(2 * Math.PI * i) / around, (Math.PI * j) / down];
      const place = [Math.sin(b) * Math.cos(a), Math.sin(b) * Math.sin(a), Math.cos(b)];
      positions.push(...place.map((x) => 0.03 * x));
      uvs.push(i / around, j / down);
    }
  for (let j = 0; j < down; j += 1)
    for (let i = 0; i < around; i += 1) {
      const [a, b] = [j * (around + 1) + i, (j + 1) * (around + 1) + i];
      if (j < down - 1) corners.push(a, b, b + 1);
      if (j > 0) corners.push(a, b + 1, a + 1);
    }
  const parts = [
    Buffer.from(Float32Array.from(positions).buffer),
    Buffer.from(Float32Array.from(uvs).buffer),
    Buffer.from(Uint32Array.from(corners).buffer),
    stripes(64),
  ];
  const count = positions.length / 3;
  const json = {
    asset: { version: '2.0' },
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [
      { primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, indices: 2, material: 0 }] },
    ],
    materials: [{ name: 'paint', pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
    textures: [{ source: 0 }],
    images: [{ bufferView: 3, mimeType: 'image/png' }],
    accessors: [
      {
        ...{ bufferView: 0, componentType: 5126, count, type: 'VEC3' },
        ...{ min: [-0.03, -0.03, -0.03], max: [0.03, 0.03, 0.03] },
      },
      { bufferView: 1, componentType: 5126, count, type: 'VEC2' },
      { bufferView: 2, componentType: 5125, count: corners.length, type: 'SCALAR' },
    ],
    bufferViews: parts.map((part, i) => ({
      buffer: 0,
      byteOffset: parts.slice(0, i).reduce((sum, { length }) => sum + length, 0),
      byteLength: part.length,
    })),
    buffers: [{ byteLength: parts.reduce((sum, { length }) => sum + length, 0) }],
  };
  return glb(JSON.stringify(json), Buffer.concat(parts));
}

function glb(json: string, bytes: Buffer): Buffer {
  const padded = (buffer: Buffer, by: number) =>
    Buffer.concat([buffer, Buffer.alloc(-buffer.length & 3, by)]);
  const [text, chunk] = [padded(Buffer.from(json), 0x20), padded(bytes, 0)];
  const words = (...numbers: number[]) => Buffer.from(Uint32Array.from(numbers).buffer);
  return Buffer.concat([
    words(0x46546c67, 2, 28 + text.length + chunk.length),
    words(text.length, 0x4e4f534a),
    text,
    words(chunk.length, 0x004e4942),
    chunk,
  ]);
}

/** A striped PNG of `size` by `size` pixels. */
export const stripes = (size: number): Buffer =>
  pngOf(size, size, (x, y) => ((x >> 3) % 2 ? [200, 40 + 3 * y, 30] : [20, 60, 40 + 3 * y]));

/** A colour that the page uses nowhere else. */
export const magenta = (size: number): Buffer => pngOf(size, size, () => [230, 20, 210]);

interface Waves {
  /** Numbers of vertices around and down. */
  around: number;
  down: number;
  /** Number of waves around; models with different numbers have different files. */
  waves: number;
  /** Name without ending, of all three files. */
  name: string;
}

/** Writes a ball of 60 mm with waves, with texture coordinates, in one colour: an OBJ with its MTL and PNG. */
export function makeWaves(folder: string, { around, down, waves, name }: Waves): string[] {
  const lines = [`mtllib ${name}.mtl`, 'usemtl paint'];
  for (let j = 0; j <= down; j += 1)
    for (let i = 0; i <= around; i += 1) {
      const [a, b] = [(2 * Math.PI * (i % around)) / around, (Math.PI * j) / down];
      const r_mm = 30 + 2 * Math.sin(waves * a) * Math.sin(b);
      const place = [Math.sin(b) * Math.cos(a), Math.sin(b) * Math.sin(a), Math.cos(b)];
      lines.push(`v ${place.map((x) => (r_mm * x).toFixed(5)).join(' ')}`);
      lines.push(`vt ${(i / around).toFixed(5)} ${(1 - j / down).toFixed(5)}`);
    }
  const at = (i: number, j: number) => j * (around + 1) + i + 1;
  for (let j = 0; j < down; j += 1)
    for (let i = 0; i < around; i += 1) {
      const [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
      if (j < down - 1) lines.push(`f ${a}/${a} ${b}/${b} ${c}/${c}`);
      if (j > 0) lines.push(`f ${a}/${a} ${c}/${c} ${d}/${d}`);
    }
  return written(folder, {
    [`${name}.obj`]: Buffer.from(`${lines.join('\n')}\n`),
    [`${name}.mtl`]: Buffer.from(`newmtl paint\nmap_Kd ${name}.png\n`),
    [`${name}.png`]: magenta(64),
  });
}

/** Writes a cylinder of `count` strips, each with a texture of its own: an OBJ with its MTL and PNGs. */
export function makeManyTextures(folder: string, count: number): string[] {
  const numbers = Array.from({ length: count }, (_, i) => i);
  const corners = numbers.flatMap((i) => {
    const place = [Math.cos, Math.sin].map((of) => (30 * of((2 * Math.PI * i) / count)).toFixed(5));
    return [`v ${place.join(' ')} 0`, `v ${place.join(' ')} 60`];
  });
  const [low, high] = [(i: number) => 2 * (i % count) + 1, (i: number) => 2 * (i % count) + 2];
  const strips = numbers.map(
    (i) => `usemtl m${i}\nf ${low(i)}/1 ${low(i + 1)}/2 ${high(i + 1)}/3 ${high(i)}/4`,
  );
  const lids = numbers
    .slice(2)
    .flatMap((i) => [
      `f ${low(0)}/1 ${low(i)}/1 ${low(i - 1)}/1`,
      `f ${high(0)}/1 ${high(i - 1)}/1 ${high(i)}/1`,
    ]);
  const uvs = ['vt 0 0', 'vt 1 0', 'vt 1 1', 'vt 0 1'];
  const obj = ['mtllib strips.mtl', ...corners, ...uvs, ...strips, ...lids];
  const mtl = numbers.map((i) => `newmtl m${i}\nmap_Kd strip${i}.png`);
  // Each picture has bytes of its own, or the daemon would store one only.
  const strip = (i: number) => pngOf(4, 4, () => [230, i % 100, 200 + Math.floor(i / 100)]);
  return written(folder, {
    'strips.obj': Buffer.from(`${obj.join('\n')}\n`),
    'strips.mtl': Buffer.from(`${mtl.join('\n')}\n`),
    ...Object.fromEntries(numbers.map((i) => [`strip${i}.png`, strip(i)])),
  });
}

/** Writes files and returns their paths. */
function written(folder: string, files: Record<string, Buffer>): string[] {
  return Object.entries(files).map(([name, bytes]) => {
    const path = join(folder, name);
    writeFileSync(path, bytes);
    return path;
  });
}

/** The panel with the preview on the page New print. */
export const previewOf = (page: Page): Locator => page.getByRole('region', { name: 'Preview' });

/** The coverage in percent that the preview shows; waits until there is one. */
export async function coverage(page: Page): Promise<number> {
  await previewOf(page).getByText('Coverage').waitFor({ timeout: 120_000 });
  return Number(/Coverage\s*([\d.]+) %/.exec(await previewOf(page).innerText())?.[1]);
}
