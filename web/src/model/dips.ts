/** The dips of a print: the one that is being changed, and those before and after it. At least one dip is always there. */
import { product, turn, type Pose } from './pose';

export interface Dip {
  pose: Pose;
  /** How deep the object is dipped. If not set, the whole object. */
  depth_mm?: number | undefined;
}

export interface Dips extends Dip {
  before: readonly Dip[];
  after: readonly Dip[];
}

/** As PlanSpec.immersions allows. */
export const kMostDips = 12;

/** All dips, in their order. */
export const dipsOf = ({ before, pose, depth_mm, after }: Dips): readonly Dip[] => [
  ...before,
  { pose, depth_mm },
  ...after,
];

/** Splits the dips at the one that is to be changed, counted from 0. There must be at least one. */
export function split(dips: readonly Dip[], at: number): Dips {
  const k = Math.max(0, Math.min(at, dips.length - 1));
  const { pose, depth_mm } = dips[k]!;
  return { before: dips.slice(0, k), pose, depth_mm, after: dips.slice(k + 1) };
}

/** Changes dip `at` from now on. */
export const select = (dips: Dips, at: number): Dips => split(dipsOf(dips), at);

/** Adds a last dip, in which the object is upside down compared with the present one, and selects it. */
export function add(dips: Dips): Dips {
  const all = dipsOf(dips);
  if (all.length >= kMostDips) return dips;
  const { pose, depth_mm } = dips;
  const over = { ...pose, rotation: product(turn('x', 180), pose.rotation) };
  return split([...all, { pose: over, depth_mm }], all.length);
}

/** Removes dip `at`, unless it is the only one. The selected dip stays selected if it is still there. */
export function remove(dips: Dips, at: number): Dips {
  const all = dipsOf(dips);
  if (all.length === 1) return dips;
  const selected = dips.before.length;
  return split(
    all.filter((_, k) => k !== at),
    selected > at ? selected - 1 : selected,
  );
}

/** Moves dip `at` to the place `to`. The selected dip stays selected. */
export function move(dips: Dips, at: number, to: number): Dips {
  const all = dipsOf(dips);
  if (!all[at] || !all[to]) return dips;
  const order = [...all.keys()];
  order.splice(to, 0, ...order.splice(at, 1));
  return split(
    order.map((k) => all[k]!),
    order.indexOf(dips.before.length),
  );
}
