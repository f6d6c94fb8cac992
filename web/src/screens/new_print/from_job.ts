/** Loads the shape of a job's object from its results, so that the model's file is not needed. */
import { batch } from '@preact/signals';
import { fetchBytes } from '../../api/call';
import { artifactPath } from '../../api/services';
import type { Vec3 } from '../../model/pose';
import { done, type Result } from '../../model/result';
import { readMesh } from '../../worker/reader';
import { draft, shape, takeDipsOfJob } from './draft';

export async function shapeOfJob(job: string): Promise<Result<void>> {
  const file = draft.value.from?.plan ? 'plan.ply' : 'surface_map.ply';
  const bytes = await fetchBytes(artifactPath(job, file));
  if (!bytes.ok) return bytes;
  const read = await readMesh(new File([bytes.value], file));
  if (!read.ok) return read;
  // The results are in mm, but the draft's scale refers to the units of the model's file.
  const scale = draft.value.from?.spec.scale ?? 1;
  const { mesh, box } = read.value;
  const shrink = (v: Vec3): Vec3 => [v[0] / scale, v[1] / scale, v[2] / scale];
  batch(() => {
    shape.value = {
      mesh: { ...mesh, positions: mesh.positions.map((value) => value / scale) },
      box: { min: shrink(box.min), max: shrink(box.max) },
    };
    takeDipsOfJob();
  });
  return done(undefined);
}
