/** Live picture of the depth camera, fetched about once a second while it is visible. */
import { signal } from '@preact/signals';
import { daemonNow } from '../../api/call';
import { camera } from '../../api/services';
import { bytesOf } from '../../model/base64';
import type { Failure } from '../../model/result';

export interface LiveDepth {
  picture: ImageBitmap;
  nearest_mm: number;
  farthest_mm: number;
  measuredShare: number;
  camera: string;
  /** Time of the picture by the daemon's clock. */
  time: Date;
}

/** The latest picture; kept until a newer one arrives. */
export const seen = signal<LiveDepth | undefined>(undefined);
/** The reason why the last request failed. */
export const trouble = signal<Failure | undefined>(undefined);

const kEvery_ms = 1000;
const kAfterTrouble_ms = 2000;

/** A picture older than this is not shown as live. */
export const kOld_s = 5;

async function ask(given: AbortSignal): Promise<void> {
  const answer = await camera.picture(given);
  if (given.aborted) return;
  if (!answer.ok) {
    trouble.value = answer.failure;
    return;
  }
  const { png, width, height, nearestMm, farthestMm, measuredShare, ageS } = answer.value;
  const picture = await createImageBitmap(new Blob([bytesOf(png)], { type: 'image/png' })).catch(
    () => undefined,
  );
  if (!picture || given.aborted) return;
  trouble.value = undefined;
  seen.value = {
    picture,
    nearest_mm: nearestMm,
    farthest_mm: farthestMm,
    measuredShare,
    camera: `${answer.value.camera}, ${width} × ${height}`,
    time: new Date(daemonNow().getTime() - 1000 * ageS),
  };
}

/** Fetches pictures while the page is visible, until the returned function is called. */
export function look(): () => void {
  const end = new AbortController();
  let timer = 0;
  let isAsking = false;
  const again = async () => {
    window.clearTimeout(timer);
    if (isAsking || document.hidden) return;
    isAsking = true;
    await ask(end.signal);
    isAsking = false;
    if (end.signal.aborted) return;
    // A running daemon cannot gain a camera, so do not try again.
    if (trouble.value?.reason === 'CAMERA_MISSING') return;
    timer = window.setTimeout(() => void again(), trouble.value ? kAfterTrouble_ms : kEvery_ms);
  };
  const onSeen = () => void again();
  document.addEventListener('visibilitychange', onSeen);
  void again();
  return () => {
    end.abort();
    window.clearTimeout(timer);
    document.removeEventListener('visibilitychange', onSeen);
  };
}
