/** Small drawings of the projections, on a 64 × 48 grid in the text colour. Toned areas are where the picture lands. */
import type { ComponentChildren } from 'preact';
import type { ProjectionName } from '../../../paint/layer';

const Drawing = ({ children }: { children: ComponentChildren }) => (
  <svg class="pictogram" viewBox="0 0 64 48" width="64" height="48" aria-hidden="true">
    {children}
  </svg>
);

/** A line along `d`. */
const Line = ({ d }: { d: string }) => <path class="line" d={d} />;
/** An area with the tone of the picture. */
const Tone = ({ d }: { d: string }) => <path class="tone" d={d} />;
/** A thin line, such as an arrow. */
const Arrow = ({ d }: { d: string }) => <path class="arrow" d={d} />;

/** An unfolded box. */
const Unfolded = () => (
  <Drawing>
    <Tone d="M8 18h48v12H8zM20 6h12v36H20z" />
    <Line d="M8 18h48v12H8zM20 6h12v36H20zM44 18v12" />
  </Drawing>
);

/** A ball over a picture that lies below it. */
const FromBelow = () => (
  <Drawing>
    <Tone d="M19 19a13 13 0 0 0 26 0z" />
    <Line d="M32 6a13 13 0 1 0 0 26 13 13 0 1 0 0-26M10 45h44" />
    <Arrow d="M22 42v-9m-2 3 2-3 2 3M32 42v-7m-2 3 2-3 2 3M42 42v-9m-2 3 2-3 2 3" />
  </Drawing>
);

/** A ball beside a picture that stands. */
const FromOneSide = () => (
  <Drawing>
    <Tone d="M40 9a15 15 0 0 0 0 30z" />
    <Line d="M40 9a15 15 0 1 0 0 30 15 15 0 1 0 0-30M7 6v36" />
    <Arrow d="M10 14h16m-3-2 3 2-3 2M10 24h12m-3-2 3 2-3 2M10 34h16m-3-2 3 2-3 2" />
  </Drawing>
);

/** A can with a band around it. */
const Around = () => (
  <Drawing>
    <Tone d="M18 16q14 7 28 0v16q-14 7-28 0z" />
    <Line d="M18 9v30q14 7 28 0V9q-14 7-28 0 14-7 28 0" />
    <Arrow d="M12 20q-8 6 2 11m-4 0 4 0-1-4M52 20q8 6-2 11m4 0-4 0 1-4" />
  </Drawing>
);

/** A box that is seen from three sides. */
const FromThreeSides = () => (
  <Drawing>
    <Tone d="M32 6l16 8v20l-16 8-16-8V14z" />
    <Line d="M32 6l16 8v20l-16 8-16-8V14zM16 14l16 8 16-8M32 22v20" />
    <Arrow d="M4 40l9-5m-4 0 4 0-2 3M60 40l-9-5m4 0-4 0 2 3M32 0v9m-2-3 2 3 2-3" />
  </Drawing>
);

/** A ball with a sticker whose corner is loose. */
const Sticker = () => (
  <Drawing>
    <Tone d="M24 16h18v12l-6 6H24z" />
    <Line d="M32 5a19 19 0 1 0 0 38 19 19 0 1 0 0-38M24 16h18v12l-6 6H24zM42 28h-6v6" />
  </Drawing>
);

const kDrawings = {
  uv: Unfolded,
  dip: FromBelow,
  planar: FromOneSide,
  cylindrical: Around,
  box: FromThreeSides,
  decal: Sticker,
} as const;

export function Pictogram({
  projection,
}: {
  projection: Exclude<ProjectionName, 'vertex_colors'>;
}) {
  const Shown = kDrawings[projection];
  return <Shown />;
}
