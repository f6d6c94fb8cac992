/** Formats numbers for display, always with a unit. */
import { done, refused, type Result } from './result';

export const formatMm = (value: number, digits = 1): string => `${value.toFixed(digits)} mm`;

export const formatShare = (share: number): string => `${(share * 100).toFixed(1)} %`;

export const formatFactor = (value: number): string => `${value.toFixed(2)} ×`;

/** "60.0 mm", "0.032 mm", "2,500 mm": three digits or 0.1 mm. */
function formatLength(mm: number): string {
  if (mm >= 999.95) return Math.round(mm).toLocaleString('en-US');
  return mm >= 10 ? mm.toFixed(1) : String(Number(mm.toPrecision(3)));
}

/** "60.0 × 40.0 × 120.5 mm". */
export const formatSize = (sides_mm: readonly number[]): string =>
  `${sides_mm.map(formatLength).join(' × ')} mm`;

export const kLengthUnits = [
  { name: 'mm', length_mm: 1 },
  { name: 'cm', length_mm: 10 },
  { name: 'inch', length_mm: 25.4 },
  { name: 'm', length_mm: 1000 },
] as const;
export type LengthUnit = (typeof kLengthUnits)[number];

/** The unit of this length; undefined if it has another length. */
export const unitOf = (length_mm: number): LengthUnit | undefined =>
  kLengthUnits.find((unit) => Math.abs(length_mm / unit.length_mm - 1) < 1e-9);

/** Returns why an object of this size is probably not meant; empty if the size is plausible. */
export function oddSize(longest_mm: number): '' | 'small' | 'large' {
  if (longest_mm < 5) return 'small';
  return longest_mm > 1000 ? 'large' : '';
}

const kUsual_mm = 150; // longest side of a usual object

/**
 * The likely unit of a model: that of its file format if the object then has a plausible size, otherwise the unit in which
 * its size is nearest to a usual one; undefined if it is plausible in none.
 * @param longest  longest side in units of the file
 */
export function likelyUnit(longest: number, format_mm?: number): LengthUnit | undefined {
  const plausible = kLengthUnits.filter((unit) => oddSize(longest * unit.length_mm) === '');
  const distance = (unit: LengthUnit) => Math.abs(Math.log((longest * unit.length_mm) / kUsual_mm));
  return (
    plausible.find((unit) => unit.length_mm === format_mm) ??
    plausible.sort((a, b) => distance(a) - distance(b))[0]
  );
}

/** "850 ms", "12 s", "3 min 05 s", "2 h 10 min", "3 d 4 h". */
export function formatSeconds(seconds: number): string {
  if (!Number.isFinite(seconds)) return '–';
  if (seconds < 0) return `-${formatSeconds(-seconds)}`;
  if (seconds < 1) return `${Math.round(seconds * 1000)} ms`;
  const whole = Math.round(seconds);
  const two = (n: number) => String(n).padStart(2, '0');
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${two(whole % 60)} s`;
  if (whole < 86400) return `${Math.floor(whole / 3600)} h ${two(Math.floor(whole / 60) % 60)} min`;
  return `${Math.floor(whole / 86400)} d ${Math.floor(whole / 3600) % 24} h`;
}

/** "812 B", "1.4 MB". */
export function formatBytes(bytes: number): string {
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let value = bytes;
  let unit = 0;
  while (value >= 1000 && unit < units.length - 1) {
    value /= 1000;
    unit += 1;
  }
  return `${unit === 0 ? value : value.toFixed(1)} ${units[unit]}`;
}

/** "14:05", "Mon 14:05", "3 Nov 14:05" or "3 Nov 2027", depending on the distance from now. */
export function formatTime(time: Date, now: Date): string {
  const clock = time.toLocaleTimeString([], { hour: '2-digit', minute: '2-digit', hour12: false });
  if (time.toDateString() === now.toDateString()) return clock;
  const days = Math.abs(now.getTime() - time.getTime()) / 86_400_000;
  if (days < 6) return `${time.toLocaleDateString('en-GB', { weekday: 'short' })} ${clock}`;
  const day = { day: 'numeric', month: 'short' } as const;
  if (time.getFullYear() !== now.getFullYear())
    return time.toLocaleDateString('en-GB', { ...day, year: 'numeric' });
  return `${time.toLocaleDateString('en-GB', day)} ${clock}`;
}

/** Converts a proto3 JSON Duration ("3.5s") to seconds; NaN if it is malformed. */
export const secondsOf = (duration: string | undefined): number =>
  duration?.endsWith('s') ? Number(duration.slice(0, -1)) : NaN;

/**
 * Parses a number with a decimal point or comma; undefined if malformed. "1,000" counts as malformed because it may mean
 * one or one thousand.
 */
export function parseNumber(text: string): number | undefined {
  const plain = text.trim();
  if (!/^[-+]?(\d+[.,]?\d*|[.,]\d+)(e[-+]?\d+)?$/i.test(plain)) return undefined;
  if (/^[-+]?[1-9]\d{0,2},\d{3}$/.test(plain)) return undefined;
  const value = Number(plain.replace(',', '.'));
  return Number.isFinite(value) ? value : undefined;
}

/** The range and unit of a number field. */
export interface NumberRange {
  min: number;
  max: number;
  unit: string;
}

/** Parses typed text; fails if it is not a number or is out of range. */
export function readNumber(text: string, { min, max, unit }: NumberRange): Result<number> {
  const remedy = `Enter ${min} to ${max} ${unit}`;
  if (text.trim() === '') return refused('Number missing', remedy);
  const value = parseNumber(text);
  if (value === undefined) return refused('Not a number', remedy);
  return value < min || value > max ? refused('Out of range', remedy) : done(value);
}
