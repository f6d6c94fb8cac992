import { useEffect, useRef, useState } from 'preact/hooks';
import { fetchBytes } from '../../api/call';
import { artifactPath } from '../../api/services';
import { colourOf, depthScale, place, type Scale } from '../../model/colour_map';
import { readGrey16, type Grey16 } from '../../model/grey16';
import { DepthLegend } from '../../ui/legend';
import { Files } from './files';
import { fileOf, type Results } from './results';

/** Frames of the depth camera, one at a time, coloured by depth. */
export function CaptureView({ results }: { results: Results }) {
  const frames = (results.artifacts.value ?? [])
    .map(fileOf)
    .filter((name) => /^frame-\d+\.png$/.test(name));
  const [at, setAt] = useState(0);
  const [frame, setFrame] = useState<Grey16>();
  const canvas = useRef<HTMLCanvasElement>(null);
  const file = frames[at];
  useEffect(() => {
    if (!file) return;
    void fetchBytes(artifactPath(results.job, file)).then(async (bytes) => {
      if (bytes.ok) setFrame(await readGrey16(bytes.value).catch(() => undefined));
    });
  }, [file]);
  const scale = frame && rangeOf(frame);
  useEffect(() => {
    if (frame && scale && canvas.current) draw(canvas.current, frame, scale);
  }, [frame]);
  return (
    <>
      {frames.length > 0 && (
        <figure class="depth">
          <canvas
            ref={canvas}
            role="img"
            aria-label={`Frame ${at + 1} of ${frames.length}, coloured by depth`}
          />
          <label>
            Frame {at + 1} of {frames.length}
            <input
              type="range"
              min={0}
              max={frames.length - 1}
              value={at}
              onInput={(event) => setAt(Number(event.currentTarget.value))}
            />
          </label>
          {scale && <DepthLegend scale={scale} />}
        </figure>
      )}
      <details>
        <summary>Files</summary>
        <Files results={results} />
      </details>
    </>
  );
}

/** Depth range from the 1st to the 99th percentile, so that outliers do not compress the colour scale. */
function rangeOf({ values }: Grey16): Scale {
  const seen = values.filter((value) => value > 0).sort();
  const min = seen[Math.floor(0.01 * seen.length)] ?? 0;
  const max = seen[Math.floor(0.99 * seen.length)] ?? 1;
  return depthScale(min, max);
}

function draw(canvas: HTMLCanvasElement, { width, height, values }: Grey16, scale: Scale): void {
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d')!;
  const image = context.createImageData(width, height);
  values.forEach((value, i) => {
    const [r, g, b] = colourOf(scale.map, value === 0 ? NaN : place(scale, value));
    image.data.set([r, g, b, 255], 4 * i);
  });
  context.putImageData(image, 0, 0);
}
