import { Refusal } from './result';

/** A depth picture; values in mm, 0 where nothing was measured. */
export interface Grey16 {
  width: number;
  height: number;
  values: Uint16Array;
}

/** Reads a 16-bit grey PNG. Browsers themselves decode only 8 bits of it. */
export async function readGrey16(bytes: ArrayBuffer): Promise<Grey16> {
  const view = new DataView(bytes);
  const damaged = new Refusal('the file is not a 16-bit grey PNG', 'Download it instead');
  if (bytes.byteLength < 45 || view.getUint32(0) !== 0x89504e47) throw damaged;
  const [width, height] = [view.getUint32(16), view.getUint32(20)];
  const [bits, colour, interlaced] = [view.getUint8(24), view.getUint8(25), view.getUint8(28)];
  if (bits !== 16 || colour !== 0 || interlaced !== 0 || width * height > 1 << 26) throw damaged;
  const parts: Uint8Array<ArrayBuffer>[] = [];
  for (let at = 8; at + 8 <= bytes.byteLength; ) {
    const length = view.getUint32(at);
    if (at + 8 + length > bytes.byteLength) throw damaged;
    if (view.getUint32(at + 4) === 0x49444154) parts.push(new Uint8Array(bytes, at + 8, length));
    at += 12 + length;
  }
  const inflated = new Blob(parts).stream().pipeThrough(new DecompressionStream('deflate'));
  const rows = new Uint8Array(await new Response(inflated).arrayBuffer());
  if (rows.length !== height * (1 + 2 * width)) throw damaged;
  return { width, height, values: unfilter(rows, width, height) };
}

function unfilter(rows: Uint8Array, width: number, height: number): Uint16Array {
  const stride = 2 * width;
  const out = new Uint8Array(stride * height);
  for (let y = 0; y < height; y += 1) {
    const filter = rows[y * (stride + 1)]!;
    for (let i = 0; i < stride; i += 1) {
      const left = i >= 2 ? out[y * stride + i - 2]! : 0;
      const up = y > 0 ? out[(y - 1) * stride + i]! : 0;
      const corner = i >= 2 && y > 0 ? out[(y - 1) * stride + i - 2]! : 0;
      const guess = [0, left, up, (left + up) >> 1, nearest(left, up, corner)][filter] ?? 0;
      out[y * stride + i] = rows[y * (stride + 1) + 1 + i]! + guess;
    }
  }
  const values = new Uint16Array(width * height);
  for (let i = 0; i < values.length; i += 1) values[i] = (out[2 * i]! << 8) | out[2 * i + 1]!;
  return values;
}

// PNG's filter type 4 (Paeth): returns the neighbour closest to left + up - corner.
function nearest(left: number, up: number, corner: number): number {
  const p = left + up - corner;
  const [a, b, c] = [Math.abs(p - left), Math.abs(p - up), Math.abs(p - corner)];
  return a <= b && a <= c ? left : b <= c ? up : corner;
}
