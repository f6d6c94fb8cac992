/** Colour maps that colour-blind people can read: rising lightness, no red against green. */

// Viridis and cividis at even steps; between them straight lines, which nobody can tell from the curve.
const kViridis = '440154 482475 414487 355f8d 2a788e 21918c 22a884 44bf70 7ad151 bddf26 fde725';
const kCividis = '00224e 123570 3b496c 575d6d 707173 8a8678 a59c74 c3b369 e1cc55 fee838';

export type Rgb = readonly [number, number, number];
export type ColourMapName = 'viridis' | 'cividis';

const parse = (stops: string): Rgb[] =>
  stops.split(' ').map((hex) => {
    const n = parseInt(hex, 16);
    return [n >> 16, (n >> 8) & 255, n & 255];
  });

const kMaps: Record<ColourMapName, Rgb[]> = { viridis: parse(kViridis), cividis: parse(kCividis) };

/** What has no value: where no film arrives. */
export const kNoValue: Rgb = [150, 150, 150];

/** Colour, each part in [0, 255], of `t`, which is clamped to [0, 1]; not a number: kNoValue. */
export function colourOf(map: ColourMapName, t: number): Rgb {
  if (Number.isNaN(t)) return kNoValue;
  const stops = kMaps[map];
  const at = Math.max(0, Math.min(1, t)) * (stops.length - 1);
  const low = Math.min(Math.floor(at), stops.length - 2);
  const share = at - low;
  const [a, b] = [stops[low]!, stops[low + 1]!];
  const mix = (i: 0 | 1 | 2) => Math.round(a[i] + share * (b[i] - a[i]));
  return [mix(0), mix(1), mix(2)];
}

/** A range of values on a colour map. */
export interface Scale {
  map: ColourMapName;
  min: number;
  max: number;
  /** By ratios instead of differences. */
  log?: boolean;
  /** The largest value stands where the map begins: the less, the brighter. */
  falls?: boolean;
}

/** Depths as all pictures of the camera have them, the daemon's too: the nearer the brighter. */
export const depthScale = (nearest_mm: number, farthest_mm: number): Scale => ({
  map: 'viridis',
  min: nearest_mm,
  max: Math.max(farthest_mm, nearest_mm + 1),
  falls: true,
});

/** Where on the map a value is; below 0 and above 1 beyond the scale. */
export function place(scale: Scale, value: number): number {
  const share = scale.log
    ? Math.log(value / scale.min) / Math.log(scale.max / scale.min)
    : (value - scale.min) / (scale.max - scale.min);
  return scale.falls ? 1 - share : share;
}

/** Round values to write beside the scale, at most about `wanted` of them. */
export function ticks(scale: Scale, wanted = 6): number[] {
  if (!(scale.max > scale.min)) return [scale.min];
  const rough = (scale.max - scale.min) / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map((m) => m * power).find((s) => s >= rough) ?? rough;
  const out: number[] = [];
  for (let i = Math.ceil(scale.min / step - 1e-9); i * step <= scale.max * (1 + 1e-9); i += 1)
    out.push(Number((i * step).toPrecision(12)));
  return out;
}
