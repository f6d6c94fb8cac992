import { Refusal } from './result';
import type { Mesh } from './mesh';

/** Reads a binary or text STL. Triangles do not share vertices. */
export function readStl(bytes: ArrayBuffer): Mesh {
  return isBinary(bytes) ? readBinary(bytes) : readText(new TextDecoder().decode(bytes));
}

// Many binary files also begin with "solid", so the length of the file decides.
function isBinary(bytes: ArrayBuffer): boolean {
  if (bytes.byteLength < 84) return false;
  const count = new DataView(bytes).getUint32(80, true);
  if (bytes.byteLength === 84 + 50 * count) return true;
  const head = new TextDecoder().decode(new Uint8Array(bytes, 0, 5));
  if (head.toLowerCase() === 'solid') return false;
  throw new Refusal(
    `the header announces ${count} triangles, which does not match the file size of ${bytes.byteLength} bytes`,
    'Copy or export the file again',
  );
}

function readBinary(bytes: ArrayBuffer): Mesh {
  const view = new DataView(bytes);
  const count = view.getUint32(80, true);
  const positions = new Float32Array(9 * count);
  for (let face = 0; face < count; face += 1)
    for (let i = 0; i < 9; i += 1)
      positions[9 * face + i] = view.getFloat32(84 + 50 * face + 12 + 4 * i, true);
  return meshOf(positions);
}

function readText(text: string): Mesh {
  const numbers: number[] = [];
  const vertex = /vertex\s+(\S+)\s+(\S+)\s+(\S+)/g;
  for (let m = vertex.exec(text); m; m = vertex.exec(text)) {
    const corner = [Number(m[1]), Number(m[2]), Number(m[3])];
    if (corner.some((n) => !Number.isFinite(n)))
      throw new Refusal(
        `vertex ${numbers.length / 3 + 1} has a coordinate that is not a number`,
        'Export the model again',
      );
    numbers.push(...corner);
  }
  if (numbers.length === 0 || numbers.length % 9 !== 0)
    throw new Refusal(
      'the STL file is incomplete or has no triangles',
      'Copy or export the file again',
    );
  return meshOf(Float32Array.from(numbers));
}

const meshOf = (positions: Float32Array): Mesh => ({
  positions,
  indices: Uint32Array.from({ length: positions.length / 3 }, (_, i) => i),
  parts: [{ material: '', first: 0, count: positions.length / 3 }],
  libraries: [],
});
