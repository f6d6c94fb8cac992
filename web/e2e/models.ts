import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { deflateSync } from 'node:zlib';

/** A ball of radius 1 in units of its own, with a striped picture: ball.obj, ball.mtl, ball.png. */
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

/** A picture of so many pixels each way, in stripes. */
function stripes(size: number): Buffer {
  const rows = Array.from({ length: size }, (_, y) => [
    0,
    ...Array.from({ length: size }, (_, x) =>
      (x >> 3) % 2 ? [200, 40 + 3 * y, 30] : [20, 60, 40 + 3 * y],
    ).flat(),
  ]);
  const head = Buffer.alloc(13);
  head.writeUInt32BE(size, 0);
  head.writeUInt32BE(size, 4);
  head.set([8, 2, 0, 0, 0], 8);
  return Buffer.concat([
    Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]),
    chunk('IHDR', head),
    chunk('IDAT', deflateSync(Buffer.from(rows.flat()))),
    chunk('IEND', Buffer.alloc(0)),
  ]);
}

function chunk(name: string, data: Buffer): Buffer {
  const body = Buffer.concat([Buffer.from(name, 'latin1'), data]);
  const out = Buffer.alloc(body.length + 8);
  out.writeUInt32BE(data.length, 0);
  body.copy(out, 4);
  out.writeUInt32BE(crc32(body), body.length + 4);
  return out;
}

function crc32(bytes: Buffer): number {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit += 1) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}
