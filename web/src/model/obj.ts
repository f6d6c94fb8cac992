import { Refusal } from './result';
import type { Mesh } from './mesh';

/** Reads a Wavefront OBJ: vertices, texture coordinates, polygons, and material names. */
export function readObj(text: string): Mesh {
  const reader = new ObjReader();
  let line = 1;
  for (let begin = 0; begin < text.length; line += 1) {
    let end = text.indexOf('\n', begin);
    if (end < 0) end = text.length;
    reader.take(text.slice(begin, end).trim(), line);
    begin = end + 1;
  }
  return reader.finish();
}

class ObjReader {
  private readonly v: number[] = [];
  private readonly vt: number[] = [];
  private readonly colours: number[] = [];
  private readonly libraries: string[] = [];
  private readonly parts: Mesh['parts'] = [];
  // Each distinct pair of position and texture coordinate becomes one vertex.
  private readonly corners = new Map<number, number>();
  private readonly positions: number[] = [];
  private readonly uvs: number[] = [];
  private readonly rgb: number[] = [];
  private readonly indices: number[] = [];
  private hasUvs = false;

  take(line: string, number: number): void {
    const [keyword, ...words] = line.split(/\s+/);
    if (keyword === 'v') this.takeVertex(words, number);
    else if (keyword === 'vt') this.vt.push(Number(words[0]), Number(words[1] ?? 0));
    else if (keyword === 'f') this.takeFace(words, number);
    else if (keyword === 'usemtl') this.begin(line.slice(6).trim());
    else if (keyword === 'mtllib') this.libraries.push(line.slice(6).trim());
  }

  finish(): Mesh {
    const last = this.parts.at(-1);
    if (last) last.count = this.indices.length - last.first;
    const parts = this.parts.filter((part) => part.count > 0);
    return {
      positions: Float32Array.from(this.positions),
      indices: Uint32Array.from(this.indices),
      ...(this.hasUvs ? { uvs: Float32Array.from(this.uvs) } : {}),
      ...(this.colours.length > 0 && this.colours.length === this.v.length
        ? { colours: Uint8Array.from(this.rgb) }
        : {}),
      parts: parts.length > 0 ? parts : [{ material: '', first: 0, count: this.indices.length }],
      libraries: this.libraries,
    };
  }

  private takeVertex(words: string[], line: number): void {
    const numbers = words.map(Number);
    if (numbers.length < 3 || numbers.slice(0, 3).some((n) => !Number.isFinite(n)))
      throw new Refusal(`line ${line}: a vertex needs three numbers`, 'Export the model again');
    this.v.push(numbers[0]!, numbers[1]!, numbers[2]!);
    if (numbers.length >= 6) this.colours.push(...numbers.slice(3, 6).map((c) => c * 255));
  }

  private takeFace(words: string[], line: number): void {
    if (words.length < 3)
      throw new Refusal(
        `line ${line}: a face needs at least three vertices`,
        'Export the model again',
      );
    const fan = words.map((word) => this.cornerOf(word, line));
    for (let i = 2; i < fan.length; i += 1) this.indices.push(fan[0]!, fan[i - 1]!, fan[i]!);
  }

  private begin(material: string): void {
    const last = this.parts.at(-1);
    if (last) last.count = this.indices.length - last.first;
    else if (this.indices.length > 0)
      this.parts.push({ material: '', first: 0, count: this.indices.length });
    this.parts.push({ material, first: this.indices.length, count: 0 });
  }

  private cornerOf(word: string, line: number): number {
    const [position, texture] = word.split('/');
    const p = this.place(position, this.v.length / 3, line);
    const t = texture ? this.place(texture, this.vt.length / 2, line) : -1;
    const key = (t + 1) * 0x4000000 + p;
    const known = this.corners.get(key);
    if (known !== undefined) return known;
    this.hasUvs ||= t >= 0;
    const corner = this.positions.length / 3;
    this.corners.set(key, corner);
    for (let i = 0; i < 3; i += 1) this.positions.push(this.v[3 * p + i]!);
    this.uvs.push(t < 0 ? 0 : this.vt[2 * t]!, t < 0 ? 0 : this.vt[2 * t + 1]!);
    for (let i = 0; i < 3; i += 1) this.rgb.push(this.colours[3 * p + i] ?? 255);
    return corner;
  }

  /** Converts an OBJ index, which counts from 1 or, if negative, back from the last element. */
  private place(word: string | undefined, count: number, line: number): number {
    const n = Number(word);
    const at = n > 0 ? n - 1 : count + n;
    if (!Number.isInteger(at) || at < 0 || at >= count)
      throw new Refusal(
        `line ${line}: a face refers to vertex or texture coordinate ${word}, which does not exist`,
        'Export the model again',
      );
    return at;
  }
}
