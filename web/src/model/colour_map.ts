/** Colour maps that colour-blind people can read: lightness increases, and red is not set against green. */

// Viridis and cividis at even steps. Linear interpolation between them is visually indistinguishable from the curves.
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

/** Colour of points without a value, where the film does not reach. */
export const kNoValue: Rgb = [150, 150, 150];

/** Returns the colour of `t`, clamped to [0, 1], with components in [0, 255]; kNoValue if `t` is NaN. */
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

/** Maps a range of values to a colour map. */
export interface Scale {
  map: ColourMapName;
  min: number;
  max: number;
  /** Logarithmic instead of linear. */
  log?: boolean;
  /** Reversed: the largest value has the darkest colour. */
  falls?: boolean;
}

/** The scale of all depth pictures, including the daemon's: nearer points are brighter. */
export const depthScale = (nearest_mm: number, farthest_mm: number): Scale => ({
  map: 'viridis',
  min: nearest_mm,
  max: Math.max(farthest_mm, nearest_mm + 1),
  falls: true,
});

/** Position of a value on the map: 0 to 1 within the scale, below 0 or above 1 outside it. */
export function place(scale: Scale, value: number): number {
  const share = scale.log
    ? Math.log(value / scale.min) / Math.log(scale.max / scale.min)
    : (value - scale.min) / (scale.max - scale.min);
  return scale.falls ? 1 - share : share;
}

/** Returns round values for the tick labels, at most about `wanted` of them. */
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
