/** The fields of a job that the form shows, with their labels. */

const kLabels = {
  mesh: 'Model',
  texture: 'Picture',
  paint: 'Picture',
  'paint.layers.sizeMm': 'Width of the picture',
  'paint.layers.turnDeg': 'Turn of the picture',
  'paint.layers.depthMm': 'Depth of the sticker',
  'paint.layers.opacity': 'Opacity',
  'paint.layers.blendMm': 'Blend over',
  profile: 'Film profile',
  scale: 'One unit is',
  calibration: 'Source of the pose',
  pose: 'Pose',
  depthMm: 'Depth',
  dipSpeedMmPerS: 'Dip speed',
  film: 'Film',
  dpi: 'Resolution',
  model: 'Simulation model',
  paper: 'Paper',
  colours: 'Colours',
} as const;

type Name = keyof typeof kLabels;

/** A field of the form. */
export interface Field {
  name: Name;
  /** The dip to which the field belongs, counted from 0; undefined if it belongs to all, or to the only one. */
  dip?: number | undefined;
}

const labelFor = ({ name, dip }: Field): string =>
  dip === undefined ? kLabels[name] : `${kLabels[name]} of dip ${dip + 1}`;

/** Properties of the input of a field. */
export const inputOf = (name: Name, dip?: number) => ({
  label: labelFor({ name, dip }),
  field: { name, dip },
});

const isKnown = (name: string): name is Name => Object.hasOwn(kLabels, name);

/** Jobs whose fields the form shows, and the groups of fields in a plan. */
const kPath =
  /^(?:simulate|plan|printImage|template|calibrate)\.(?:(?:object|film|immersions\[(\d+)\])\.)?(.+)/;

/** The field of the form at a path in a job ("plan.immersions[1].depth_mm") or above it; undefined if there is none. */
export function fieldAt(path: string): Field | undefined {
  const inApi = path.replace(/_([a-z])/g, (_, letter: string) => letter.toUpperCase());
  const [, dip, place = ''] = kPath.exec(inApi) ?? [];
  const names = place.replace(/\[\d+\]/g, '').split('.');
  while (names.length > 0) {
    const name = names.join('.');
    if (isKnown(name)) return { name, ...(dip ? { dip: Number(dip) } : {}) };
    names.pop();
  }
  return undefined;
}

/** A problem after the label of its field. Fields that the form lacks have their path as label; "" names no field. */
export function withLabel(path: string, problem: string): string {
  const field = fieldAt(path);
  const label = field ? labelFor(field) : path;
  return label ? `${label}: ${problem}` : problem;
}
