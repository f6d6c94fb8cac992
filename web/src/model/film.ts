/** A film, named as in the API. */
export interface Film {
  /** "A4", "A3", "letter", "WxH" in mm or "circle:RADIUS" in mm. */
  name: string;
  width_mm: number;
  height_mm: number;
  /** Set for a round film only. */
  radius_mm?: number;
}

const kSheets: Record<string, readonly [number, number]> = {
  A4: [210, 297],
  A3: [297, 420],
  letter: [215.9, 279.4],
};

/** Returns the film of that name; undefined if the name is unknown or a polygon, which also needs a file. */
export function filmOf(name: string): Film | undefined {
  const sheet = kSheets[name];
  if (sheet) return { name, width_mm: sheet[0], height_mm: sheet[1] };
  const circle = /^circle:(\d+(?:\.\d+)?)$/.exec(name);
  if (circle) {
    const radius_mm = Number(circle[1]);
    if (radius_mm <= 0) return undefined;
    return { name, width_mm: 2 * radius_mm, height_mm: 2 * radius_mm, radius_mm };
  }
  const size = /^(\d+(?:\.\d+)?)x(\d+(?:\.\d+)?)$/.exec(name);
  if (!size) return undefined;
  const [width_mm, height_mm] = [Number(size[1]), Number(size[2])];
  return width_mm > 0 && height_mm > 0 ? { name, width_mm, height_mm } : undefined;
}

export const kFilmChoices: readonly { name: string; label: string }[] = [
  { name: 'A4', label: 'A4 sheet, 210 × 297 mm' },
  { name: 'A3', label: 'A3 sheet, 297 × 420 mm' },
  { name: 'letter', label: 'Letter sheet, 215.9 × 279.4 mm' },
  { name: 'circle:105', label: 'Round, radius 105 mm' },
];
