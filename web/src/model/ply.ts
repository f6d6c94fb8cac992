import { Refusal } from './result';

/** An element of a PLY file: its scalar properties and its list properties, by name. */
export interface PlyElement {
  count: number;
  columns: Map<string, Float64Array>;
  lists: Map<string, { lengths: Uint32Array; values: Float64Array }>;
}

type Kind = 'i1' | 'u1' | 'i2' | 'u2' | 'i4' | 'u4' | 'f4' | 'f8';
interface Property {
  name: string;
  kind: Kind;
  /** For a list: the type of its length. */
  length?: Kind;
}
interface Header {
  format: string;
  elements: { name: string; count: number; properties: Property[] }[];
  size: number;
}

const kKinds: Record<string, Kind> = {
  char: 'i1', int8: 'i1', uchar: 'u1', uint8: 'u1',
  short: 'i2', int16: 'i2', ushort: 'u2', uint16: 'u2',
  int: 'i4', int32: 'i4', uint: 'u4', uint32: 'u4',
  float: 'f4', float32: 'f4', double: 'f8', float64: 'f8',
}; // prettier-ignore

const kAgain = 'Copy or export the file again';

/** Reads any PLY file, text or binary. */
export function readPly(bytes: ArrayBuffer): Map<string, PlyElement> {
  const header = readHeader(bytes);
  const source =
    header.format === 'ascii'
      ? new Words(new TextDecoder().decode(new Uint8Array(bytes, header.size)))
      : new Binary(bytes, header.size, header.format === 'binary_little_endian');
  const elements = new Map<string, PlyElement>();
  for (const { name, count, properties } of header.elements) {
    // The header is untrusted. Each row takes at least a byte, so a larger count cannot be right.
    if (count > bytes.byteLength)
      throw new Refusal(
        `the header announces ${count} elements "${name}", but the file is too short for them`,
        kAgain,
      );
    elements.set(name, readElement(source, count, properties));
  }
  return elements;
}

function headerOf(bytes: ArrayBuffer): string {
  const text = new TextDecoder('latin1').decode(
    new Uint8Array(bytes, 0, Math.min(bytes.byteLength, 65536)),
  );
  const end = /^ply\r?\n[\s\S]*?\nend_header\r?\n/.exec(text);
  if (!end) throw new Refusal('the file has no valid PLY header', kAgain);
  return end[0];
}

function readHeader(bytes: ArrayBuffer): Header {
  const text = headerOf(bytes);
  const header: Header = { format: '', elements: [], size: text.length };
  for (const line of text.split(/\r?\n/)) {
    const words = line.trim().split(/\s+/);
    if (words[0] === 'format') header.format = words[1] ?? '';
    if (words[0] === 'element')
      header.elements.push({ name: words[1] ?? '', count: Number(words[2]), properties: [] });
    if (words[0] === 'property') header.elements.at(-1)?.properties.push(propertyOf(words));
  }
  if (!['ascii', 'binary_little_endian', 'binary_big_endian'].includes(header.format))
    throw new Refusal(`the PLY format "${header.format}" is unknown`, kAgain);
  if (header.elements.some(({ count }) => !Number.isInteger(count) || count < 0))
    throw new Refusal(
      'an element count in the PLY header is negative or not a whole number',
      kAgain,
    );
  return header;
}

function propertyOf(words: string[]): Property {
  const isList = words[1] === 'list';
  const kind = kKinds[words[isList ? 3 : 1] ?? ''];
  const length = isList ? kKinds[words[2] ?? ''] : undefined;
  if (!kind || (isList && !length))
    throw new Refusal(
      `the PLY header has a property of unknown type, "${words.join(' ')}"`,
      kAgain,
    );
  return { name: words.at(-1) ?? '', kind, ...(length ? { length } : {}) };
}

function readElement(source: Words | Binary, count: number, properties: Property[]): PlyElement {
  const columns = new Map<string, Float64Array>();
  const lists = new Map<string, { lengths: Uint32Array; values: Float64Array }>();
  const rows = properties.map((property) => {
    if (property.length)
      return { property, lengths: new Uint32Array(count), values: [] as number[] };
    const column = new Float64Array(count);
    columns.set(property.name, column);
    return { property, column };
  });
  for (let row = 0; row < count; row += 1) {
    for (const { property, column, lengths, values } of rows) {
      if (column) column[row] = source.next(property.kind);
      if (!lengths) continue;
      lengths[row] = source.next(property.length!);
      for (let i = lengths[row]!; i > 0; i -= 1) values.push(source.next(property.kind));
    }
  }
  for (const { property, lengths, values } of rows)
    if (lengths) lists.set(property.name, { lengths, values: Float64Array.from(values) });
  return { count, columns, lists };
}

class Words {
  private readonly words: IterableIterator<RegExpMatchArray>;
  constructor(text: string) {
    this.words = text.matchAll(/\S+/g);
  }
  next(_kind: Kind): number {
    const { value, done } = this.words.next();
    if (done) throw new Refusal('the file is incomplete', kAgain);
    return Number(value[0]);
  }
}

class Binary {
  private readonly view: DataView;
  constructor(
    bytes: ArrayBuffer,
    private at: number,
    private readonly little: boolean,
  ) {
    this.view = new DataView(bytes);
  }
  next(kind: Kind): number {
    const begin = this.at;
    this.at += Number(kind[1]);
    if (this.at > this.view.byteLength) throw new Refusal('the file is incomplete', kAgain);
    switch (kind) {
      case 'i1':
        return this.view.getInt8(begin);
      case 'u1':
        return this.view.getUint8(begin);
      case 'i2':
        return this.view.getInt16(begin, this.little);
      case 'u2':
        return this.view.getUint16(begin, this.little);
      case 'i4':
        return this.view.getInt32(begin, this.little);
      case 'u4':
        return this.view.getUint32(begin, this.little);
      case 'f4':
        return this.view.getFloat32(begin, this.little);
      case 'f8':
        return this.view.getFloat64(begin, this.little);
    }
  }
}

/** Returns the vertex indices of all faces, split into triangles. */
export function trianglesOf(elements: Map<string, PlyElement>): Uint32Array {
  const face = elements.get('face');
  const list = face?.lists.get('vertex_indices') ?? face?.lists.get('vertex_index');
  if (!list) throw new Refusal('the file has points, but no faces', 'Export the model as a mesh');
  const out: number[] = [];
  let at = 0;
  for (const length of list.lengths) {
    for (let i = 2; i < length; i += 1)
      out.push(list.values[at]!, list.values[at + i - 1]!, list.values[at + i]!);
    at += length;
  }
  return Uint32Array.from(out);
}

/** Returns the named columns, interleaved row by row; undefined if one is missing. */
export function columnsOf(element: PlyElement, names: string[]): Float32Array | undefined {
  const columns = names.map((name) => element.columns.get(name));
  if (columns.some((column) => !column)) return undefined;
  const out = new Float32Array(element.count * names.length);
  columns.forEach((column, i) => {
    for (let row = 0; row < element.count; row += 1) out[row * names.length + i] = column![row]!;
  });
  return out;
}
