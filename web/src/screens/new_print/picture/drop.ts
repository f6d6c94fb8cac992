/** Where a dropped picture goes: onto the object as a decal, or to the texture. */
import type { Quaternion } from '../../../model/pose';
import { roleOf, type Named } from '../../../model/files';
import type { SurfacePoint } from '../../../view3d/pose_view';
import type { LayerChoices } from './choices';
import { sight, uprightFor } from './directions';
import { opposite, rounded, roundedVector, unit } from './vectors';

/** The picture that lands where it was dropped; undefined if it is a texture or comes with other files. */
export function landing<F extends Named>(
  files: readonly F[],
  hit: SurfacePoint | undefined,
): F | undefined {
  const [file, ...others] = files;
  return file && hit && others.length === 0 && roleOf(file.name) === 'image' ? file : undefined;
}

const kShareOfObject = 1 / 3;

/**
 * A decal on the surface that is upright in the view.
 * @param aspect  width of the picture divided by its height
 */
export function decalAt(
  { point_mm, normal }: SurfacePoint,
  longest_mm: number,
  aspect: number,
  rotation_FO: Quaternion,
): LayerChoices {
  const direction = opposite(unit(normal));
  return {
    projection: 'decal',
    position_mm: roundedVector(point_mm, 2),
    ...sight(direction, uprightFor(direction, rotation_FO)),
    size_mm: rounded(kShareOfObject * longest_mm * Math.min(1, aspect), 1) || 0.1,
  };
}
