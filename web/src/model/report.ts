/** The parts of a worker's report.json that the page reads. Any of them may be missing. */

export interface Warning {
  code: string;
  message: string;
  where: string;
}

export interface Report {
  verb?: string;
  parameters?: {
    scale?: number;
    pose?: { rotation_wxyz: number[]; translation_mm: number[] };
    film?: { name: string; min_mm: number[]; max_mm: number[] };
    profile?: { tear_stretch?: number; wrinkle_stretch?: number };
    dip_speed_mm_per_s?: number;
    dpi?: number;
    film_image_px?: number[];
    model?: string;
    /** The planned depth, mm. For a simulation it may also be "full". */
    depth_mm?: number | string;
    /** For a dip only. */
    speed_mm_per_s?: number;
  };
  depth_mm?: number;
  coverage?: number;
  stretch?: { p50: number; p95: number; max: number };
  /** Stated error of the film points; null if no bound is known. */
  error?: {
    p50_mm: number | null;
    p95_mm: number | null;
    above_pixel_share: number;
    no_bound_share: number;
  } | null;
  total_seconds?: number;
  warnings?: Warning[];
}

export const warningsOf = (report: Report | undefined): Warning[] => report?.warnings ?? [];

/** Parses "12.30 mm immersion, at (-4.00, 17.50) mm" as a point in the film frame at first contact, mm. */
export function placeOf(where: string): readonly [number, number, number] | undefined {
  const number = '(-?\\d+(?:\\.\\d+)?)';
  const found = new RegExp(`^${number} mm immersion, at \\(${number}, ${number}\\) mm$`).exec(
    where,
  );
  if (!found) return undefined;
  return [Number(found[2]), Number(found[3]), Number(found[1])];
}
