/** Reads the object of a job again from the job's own files. */
import { batch } from '@preact/signals';
import type { InputFile } from '../../api/types';
import { done, type Result } from '../../model/result';
import { draft, shape, takeDipsOfJob } from './draft';
import { readModel, stage } from './reading';

export async function shapeOfJob(): Promise<Result<void>> {
  const { from } = draft.value;
  if (!from) return done(undefined);
  const { mesh, extraFiles, scale, texture, paint } = from.spec;
  const source = {
    mesh: mesh as InputFile,
    extraFiles: (extraFiles as InputFile[]).filter(({ name }) => !/\.json$/i.test(name)),
  };
  // The page does not have the picture of a job, and does not show other colours instead.
  const shapeOnly = texture !== undefined || paint !== undefined;
  const read = await readModel(
    source,
    { scale: scale ?? 1, shapeOnly },
    new AbortController().signal,
  );
  stage.value = undefined;
  if (!read.ok) return read;
  batch(() => {
    shape.value = read.value;
    takeDipsOfJob();
  });
  return done(undefined);
}
