/** Reads the film image in a PDF of print-image: rows as in a PNG, compressed. */
import { inflateSync } from 'node:zlib';

export interface Samples {
  width: number;
  height: number;
  channels: number;
  samples: Uint8Array;
}

/** Returns the first image. Throws if the PDF has no image. */
export function imageIn(pdf: Buffer): Samples {
  const text = pdf.toString('latin1');
  const mark = text.indexOf('/Subtype /Image');
  if (mark < 0) throw new Error('the PDF has no image');
  const begin = /stream\r?\n/.exec(text.slice(mark))!;
  const start = mark + begin.index + begin[0].length;
  const dictionary = text.slice(text.lastIndexOf(' obj', mark), mark + begin.index);
  const number = (key: string) => Number(new RegExp(`/${key} (\\d+)`).exec(dictionary)![1]);
  const [width, height, channels] = [number('Width'), number('Height'), number('Colors')];
  const rows = inflateSync(pdf.subarray(start, text.indexOf('endstream', start)));
  return { width, height, channels, samples: unfiltered(rows, width * channels, height, channels) };
}

/** Undoes the filters of PNG. */
function unfiltered(rows: Buffer, length: number, height: number, step: number): Uint8Array {
  const out = new Uint8Array(length * height);
  for (let y = 0; y < height; y += 1) {
    const filter = rows[y * (length + 1)]!;
    for (let i = 0; i < length; i += 1) {
      const at = y * length + i;
      const left = i < step ? 0 : out[at - step]!;
      const above = y === 0 ? 0 : out[at - length]!;
      const corner = i < step || y === 0 ? 0 : out[at - length - step]!;
      out[at] = rows[y * (length + 1) + 1 + i]! + predicted(filter, left, above, corner);
    }
  }
  return out;
}

function predicted(filter: number, left: number, above: number, corner: number): number {
  switch (filter) {
    case 1:
      return left;
    case 2:
      return above;
    case 3:
      return (left + above) >> 1;
    case 4:
      return paeth(left, above, corner);
    default:
      return 0;
  }
}

function paeth(left: number, above: number, corner: number): number {
  const [a, b, c] = [left, above, corner].map((x) => Math.abs(left + above - corner - x));
  if (a! <= b! && a! <= c!) return left;
  return b! <= c! ? above : corner;
}
