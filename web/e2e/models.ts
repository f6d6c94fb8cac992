import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
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
