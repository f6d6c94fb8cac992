/** Uploads the files of a model and has them read, with progress. What passes by itself is waited for. */
import { signal } from '@preact/signals';
import type { InputFile } from '../../api/types';
import { upload } from '../../api/uploads';
import { daemon } from '../../engine/daemon';
import { refused, done, type Failure, type Result } from '../../model/result';
import type { Shape } from './draft';

/** What the page is doing with a model. */
export interface Stage {
  /** For display: "Uploading spot.obj". */
  text: string;
  /** Share that is done; undefined if it is not known. */
  share?: number;
}

/** Defined while a model is uploaded or read. */
export const stage = signal<Stage | undefined>(undefined);

interface Outgoing {
  name: string;
  file: File;
}

/** The assets of files that were uploaded by this page. */
const assets = new WeakMap<File, string>();

const kWaits_s = [0.5, 1, 2, 4];
const pause = (tries: number): Promise<void> =>
  new Promise((resolve) => setTimeout(resolve, 1000 * kWaits_s[Math.min(tries, 3)]!));

/** What to say while a failure lasts that ends by itself; undefined for other failures. */
export function whyWait({ status, reason }: Failure): string | undefined {
  if (reason === 'PREVIEWS_FULL') return 'Others use all previews; waiting for a free one';
  if (reason === 'PREVIEW_SUPERSEDED') return 'Another page of yours uses the preview; waiting';
  if (status === 0 || status === 503) return 'The daemon does not answer; waiting until it does';
  return undefined;
}

/** Uploads files unless this page has done so. Tells how far it is. */
export async function bring(
  files: readonly Outgoing[],
  tell: (stage: Stage) => void,
  signal: AbortSignal,
): Promise<Result<InputFile[]>> {
  const out: InputFile[] = [];
  const total = files.reduce((sum, { file }) => sum + file.size, 0);
  let before = 0;
  for (const { name, file } of files) {
    const progress = (share: number, isLost: boolean) =>
      tell({
        text: isLost ? `Connection lost; the upload of ${name} will resume` : `Uploading ${name}`,
        share: total > 0 ? (before + share * file.size) / total : 1,
      });
    if (!assets.has(file)) {
      progress(0, false);
      const asset = await upload(file, progress, signal);
      if (!asset.ok) return named(asset, name);
      assets.set(file, asset.value);
    }
    out.push({ name, asset: assets.get(file)! });
    before += file.size;
  }
  return done(out);
}

const named = ({ failure }: { failure: Failure }, name: string) => ({
  ok: false as const,
  failure: { ...failure, what: `${name}: ${failure.what}` },
});

/** Forgets that the files were uploaded, because the daemon does not have them any more. */
export const forget = (files: readonly File[]): void =>
  files.forEach((file) => assets.delete(file));

/** Reads a model. If its colours cannot be read, its shape is. */
export async function readModel(
  source: Shape['source'],
  how: { scale: number; shapeOnly?: boolean },
  signal: AbortSignal,
): Promise<Result<Shape>> {
  const read = await readPatiently(source, how, signal);
  if (read.ok || how.shapeOnly || read.failure.reason !== 'INPUT_REFUSED') return read;
  const shape = await readPatiently(source, { ...how, shapeOnly: true }, signal);
  return shape.ok ? done({ ...shape.value, colourless: read.failure }) : shape;
}

async function readPatiently(
  source: Shape['source'],
  how: { scale: number; shapeOnly?: boolean },
  signal: AbortSignal,
): Promise<Result<Shape>> {
  for (let tries = 0; ; tries += 1) {
    stage.value = { text: 'Reading the model' };
    const read = await daemon.read({ ...source, ...how }, signal);
    if (read.ok) return done({ ...read.value, source });
    const why = whyWait(read.failure);
    if (!why || signal.aborted) return read;
    stage.value = { text: why };
    await pause(tries);
    if (signal.aborted) return refused('cancelled', undefined, { reason: 'ABORTED_HERE' });
  }
}
