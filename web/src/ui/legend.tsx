import { useEffect, useRef } from 'preact/hooks';
import { colourOf, place, ticks, type Scale } from '../model/colour_map';

/** A colour map with tick labels. */
export function Legend(props: {
  title: string;
  unit: string;
  scale: Scale;
  values?: number[];
  beyond?: string;
  /** Meaning of grey. */
  grey?: string;
}) {
  const { scale } = props;
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const context = canvas.current!.getContext('2d')!;
    for (let i = 0; i < 256; i += 1) {
      context.fillStyle = `rgb(${colourOf(scale.map, i / 255).join(' ')})`;
      context.fillRect(i, 0, 1, 1);
    }
  }, [scale.map]);
  const marks = props.values ?? ticks(scale, 5);
  if (scale.falls) marks.reverse();
  return (
    <figure class="legend">
      <figcaption>
        {props.title} [{props.unit}]
      </figcaption>
      <canvas ref={canvas} width={256} height={1} aria-hidden="true" />
      <div class="ticks">
        {marks.map((value, i) => (
          <span key={value} style={{ left: `${100 * place(scale, value)}%` }}>
            {props.beyond && i === marks.length - 1 ? '≥ ' : ''}
            {value}
          </span>
        ))}
      </div>
      <p class="quiet">
        Grey: {props.grey ?? 'not reached by the film'}.
        {props.beyond && ` ≥ ${marks.at(-1)}: ${props.beyond}.`}
      </p>
    </figure>
  );
}

/** The legend of a depth picture. */
export const DepthLegend = ({ scale }: { scale: Scale }) => (
  <Legend title="Distance from the camera" unit="mm" scale={scale} grey="not measured" />
);
