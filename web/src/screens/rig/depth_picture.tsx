import { useEffect, useRef } from 'preact/hooks';
import { depthScale } from '../../model/colour_map';
import { formatSeconds, formatShare } from '../../model/units';
import { secondsUntil } from '../../ui/clock';
import { DepthLegend } from '../../ui/legend';
import { kOld_s, look, seen, trouble, type LiveDepth } from './live_depth';

/** The live picture of the depth camera. Every user can see it without the lease. */
export function DepthPicture() {
  useEffect(() => look(), []);
  const why = trouble.value;
  if (why?.reason === 'CAMERA_MISSING')
    return (
      <section aria-labelledby="depth-title">
        <h2 id="depth-title">Depth camera</h2>
        <p class="quiet">No camera is configured.</p>
      </section>
    );
  return (
    <section aria-labelledby="depth-title">
      <h2 id="depth-title">Depth camera</h2>
      {seen.value && <Picture shown={seen.value} />}
      {!seen.value && !why && <p class="quiet">Waiting for the first picture…</p>}
      {why && (
        <p class="warning" role="status">
          {seen.value ? `No picture since ${clockOf(seen.value.time)}` : 'No picture'}: {why.what}.
          The page tries again while it is open.
        </p>
      )}
    </section>
  );
}

const clockOf = (time: Date): string => time.toLocaleTimeString([], { hour12: false });

function Picture({ shown }: { shown: LiveDepth }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const { width, height } = shown.picture;
    Object.assign(canvas.current!, { width, height });
    canvas.current!.getContext('2d')!.drawImage(shown.picture, 0, 0);
  }, [shown]);
  const age_s = Math.max(0, -(secondsUntil(shown.time.toISOString()) ?? 0));
  const isOld = age_s > kOld_s;
  const range = `${shown.nearest_mm.toFixed(0)} to ${shown.farthest_mm.toFixed(0)} mm`;
  return (
    <figure class={`depth ${isOld ? 'old' : ''}`}>
      <canvas
        ref={canvas}
        role="img"
        aria-label={`Depth over the vat at ${clockOf(shown.time)}: ${range} from the camera, ${formatShare(shown.measuredShare)} measured`}
      />
      <DepthLegend scale={depthScale(shown.nearest_mm, shown.farthest_mm)} />
      <figcaption class="quiet">
        {range}, {formatShare(shown.measuredShare)} measured, {formatSeconds(Math.round(age_s))}{' '}
        old. {shown.camera}.
      </figcaption>
    </figure>
  );
}
