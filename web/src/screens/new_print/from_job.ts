/** Loads the shape of a job's object from its surface map, so that the model's file is not needed. */
import { batch } from '@preact/signals';
import { fetchBytes } from '../../api/call';
import { artifactPath } from '../../api/services';
import type { Mesh } from '../../model/mesh';
import { done, type Result } from '../../model/result';
import { readMap } from '../../worker/reader';
import { draft, shape, takePoseOfJob } from './draft';

export async function shapeOfJob(job: string): Promise<Result<void>> {
  const bytes = await fetchBytes(artifactPath(job, 'surface_map.ply'));
  if (!bytes.ok) return bytes;
  const map = await readMap(bytes.value);
  if (!map.ok) return map;
  // The map is in mm, but the draft's scale refers to the units of the model's file.
  const scale = draft.value.from?.spec.scale ?? 1;
  const unscaled = map.value.positions.map((value) => value / scale);
  const shrink = (v: readonly [number, number, number]) =>
    [v[0] / scale, v[1] / scale, v[2] / scale] as const;
  const mesh: Mesh = {
    positions: unscaled,
    indices: map.value.indices,
    parts: [{ material: '', first: 0, count: map.value.indices.length }],
    libraries: [],
  };
  batch(() => {
    shape.value = {
      mesh,
      box: { min: shrink(map.value.box.min), max: shrink(map.value.box.max) },
    };
    takePoseOfJob();
  });
  return done(undefined);
}
