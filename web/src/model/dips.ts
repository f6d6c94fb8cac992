/**
 * The dips of a print: the pose of the one that is being changed, and the poses of those before and after it. At least one
 * dip is always there.
 */
import { product, turn, type Pose } from './pose';

export interface Dips {
  pose: Pose;
  before: readonly Pose[];
  after: readonly Pose[];
}

/** As PlanSpec.immersions allows. */
export const kMostDips = 12;

/** All poses, in the order of the dips. */
export const posesOf = ({ before, pose, after }: Dips): readonly Pose[] => [
  ...before,
  pose,
  ...after,
];

/** Splits the poses at the dip that is to be changed, counted from 0. */
function split(poses: readonly Pose[], at: number): Dips {
  const k = Math.max(0, Math.min(at, poses.length - 1));
  return { before: poses.slice(0, k), pose: poses[k]!, after: poses.slice(k + 1) };
}

/** Changes dip `at` from now on. */
export const select = (dips: Dips, at: number): Dips => split(posesOf(dips), at);

/** Adds a last dip, in which the object is upside down compared with the present one, and selects it. */
export function add(dips: Dips): Dips {
  const poses = posesOf(dips);
  if (poses.length >= kMostDips) return dips;
  const over = { ...dips.pose, rotation: product(turn('x', 180), dips.pose.rotation) };
  return split([...poses, over], poses.length);
}

/** Removes dip `at`, unless it is the only one. The selected dip stays selected if it is still there. */
export function remove(dips: Dips, at: number): Dips {
  const poses = posesOf(dips);
  if (poses.length === 1) return dips;
  const selected = dips.before.length;
  return split(
    poses.filter((_, k) => k !== at),
    selected > at ? selected - 1 : selected,
  );
}
