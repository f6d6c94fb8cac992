/** One sample of the axis position from a dip's positions.csv. */
export interface Sample {
  t_s: number;
  position_mm: number;
}

/** Reads positions.csv and skips incomplete lines, which an interrupted dip can leave. */
export function readPositions(text: string): Sample[] {
  const [head = '', ...lines] = text.split('\n');
  const names = head.trim().split(',');
  const [t, at] = [names.indexOf('t_s'), names.indexOf('position_mm')];
  if (t < 0 || at < 0) return [];
  return lines
    .map((line) => line.split(','))
    .filter((cells) => cells.length >= names.length)
    .map((cells) => ({ t_s: Number(cells[t]), position_mm: Number(cells[at]) }))
    .filter(({ t_s, position_mm }) => Number.isFinite(t_s) && Number.isFinite(position_mm));
}
