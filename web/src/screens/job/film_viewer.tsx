import { useEffect, useRef, useState } from 'preact/hooks';
import { fit, pan, pixelAt, zoomAt, type View } from '../../model/pan_zoom';
import { Button } from '../../ui/controls';
import type { FilmImage } from './results';

interface Props {
  film: FilmImage;
  /** The film image without compensation, for comparison; undefined until it is requested. */
  straight: ImageBitmap | undefined;
  computeStraight: () => Promise<void>;
}

/** A viewer for the film image that can zoom to single pixels. */
export function FilmViewer({ film, straight, computeStraight }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const { picture } = film;
  const [view, setView] = useState<View>();
  const [split, setSplit] = useState(100);
  const [under, setUnder] = useState<[number, number]>();
  const hands = useHands(canvas, film, view, setView);

  useEffect(() => {
    const element = canvas.current!;
    const resize = () => {
      const ratio = window.devicePixelRatio;
      element.width = Math.round(element.clientWidth * ratio);
      element.height = Math.round(element.clientHeight * ratio);
      setView(fit(picture, element));
    };
    const watch = new ResizeObserver(resize);
    watch.observe(element);
    resize();
    return () => watch.disconnect();
  }, [picture]);

  useEffect(() => {
    if (canvas.current && view) draw(canvas.current, view, film, straight, split / 100);
  });

  const zoomBy = (factor: number) => {
    const { width, height } = canvas.current!;
    setView(zoomAt(view!, factor, width / 2, height / 2, fit(picture, canvas.current!).zoom / 2));
  };
  return (
    <div class="film-viewer">
      <canvas
        ref={canvas}
        tabIndex={0}
        role="img"
        aria-label="The film image. The plus and minus keys zoom, the arrow keys move the image, 1 shows actual pixels, 0 shows the whole image."
        {...hands}
        onPointerMove={(event) => {
          hands.onPointerMove(event);
          const [x, y] = placeIn(event);
          setUnder(view && pixelAt(view, x, y, picture));
        }}
        onPointerLeave={() => setUnder(undefined)}
      />
      <div class="tools">
        <span class="group" role="group" aria-label="Zoom">
          <button type="button" class="plain" aria-label="Zoom in" onClick={() => zoomBy(1.5)}>
            +
          </button>
          <button type="button" class="plain" aria-label="Zoom out" onClick={() => zoomBy(1 / 1.5)}>
            −
          </button>
          <button
            type="button"
            class="plain"
            onClick={() => setView(fit(picture, canvas.current!))}
          >
            Fit
          </button>
          <button type="button" class="plain" onClick={() => zoomBy(1 / view!.zoom)}>
            1 : 1
          </button>
        </span>
        <span class="quiet readout">
          {under ? inWords(under, film) : `${Math.round(100 * (view?.zoom ?? 1))} %`}
        </span>
      </div>
      {straight ? (
        <label class="compare">
          <span>with compensation</span>
          <input
            type="range"
            min={0}
            max={100}
            value={split}
            aria-label="Position of the divider: the film image is on its left, the image without compensation on its right"
            onInput={(event) => setSplit(Number(event.currentTarget.value))}
          />
          <span>without compensation</span>
        </label>
      ) : (
        <Button
          kind="plain"
          onPress={async () => {
            await computeStraight();
            setSplit(50);
          }}
        >
          Compare with the image without compensation
        </Button>
      )}
    </div>
  );
}

const placeIn = (event: PointerEvent | WheelEvent): [number, number] => {
  const box = (event.currentTarget as Element).getBoundingClientRect();
  const ratio = window.devicePixelRatio;
  return [(event.clientX - box.left) * ratio, (event.clientY - box.top) * ratio];
};

/** "pixel 812, 1403 · x -36.2 mm, y 29.7 mm", on the film. */
function inWords([i, j]: [number, number], { picture, pitch_mm }: FilmImage): string {
  const x = (i + 0.5 - picture.width / 2) * pitch_mm;
  const y = (picture.height / 2 - j - 0.5) * pitch_mm;
  return `pixel ${i}, ${j} · x ${x.toFixed(1)} mm, y ${y.toFixed(1)} mm`;
}

function draw(
  canvas: HTMLCanvasElement,
  view: View,
  film: FilmImage,
  straight: ImageBitmap | undefined,
  share: number,
): void {
  const context = canvas.getContext('2d')!;
  const { width, height } = film.picture;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  // Enlarged pixels are not smoothed.
  context.imageSmoothingEnabled = view.zoom < 1;
  context.imageSmoothingQuality = 'high';
  context.setTransform(view.zoom, 0, 0, view.zoom, view.x, view.y);
  if (!straight || share >= 1) {
    context.drawImage(film.picture, 0, 0);
    return;
  }
  const cut = share * width;
  const clipped = (from: number, to: number, picture: ImageBitmap) => {
    context.save();
    context.beginPath();
    context.rect(from, 0, to - from, height);
    context.clip();
    context.drawImage(picture, 0, 0, width, height);
    context.restore();
  };
  clipped(0, cut, film.picture);
  clipped(cut, width, straight);
  context.fillStyle = '#0b6e99';
  context.fillRect(cut - 1 / view.zoom, 0, 2 / view.zoom, height);
}

/** Handles dragging, pinching, the mouse wheel and keys. */
function useHands(
  canvas: { current: HTMLCanvasElement | null },
  { picture }: FilmImage,
  view: View | undefined,
  setView: (view: View) => void,
) {
  const fingers = useRef(new Map<number, [number, number]>());
  const least = () => fit(picture, canvas.current!).zoom / 2;
  const onPointerDown = (event: PointerEvent) => {
    canvas.current!.setPointerCapture(event.pointerId);
    fingers.current.set(event.pointerId, placeIn(event));
  };
  const onPointerMove = (event: PointerEvent) => {
    const before = fingers.current.get(event.pointerId);
    if (!before || !view) return;
    const now = placeIn(event);
    const other = [...fingers.current].find(([id]) => id !== event.pointerId)?.[1];
    fingers.current.set(event.pointerId, now);
    if (other) {
      const apart = (p: [number, number]) => Math.hypot(p[0] - other[0], p[1] - other[1]);
      const [x, y] = [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2];
      setView(zoomAt(view, apart(now) / Math.max(1, apart(before)), x, y, least()));
    } else {
      setView(pan(view, now[0] - before[0], now[1] - before[1], picture, canvas.current!));
    }
  };
  const onPointerUp = (event: PointerEvent) => fingers.current.delete(event.pointerId);
  const onKeyDown = (event: KeyboardEvent) => {
    if (!view || !canvas.current) return;
    const { width, height } = canvas.current;
    const zoom = (factor: number) => zoomAt(view, factor, width / 2, height / 2, least());
    const move = (dx: number, dy: number) => pan(view, dx, dy, picture, canvas.current!);
    const moves: Record<string, () => View> = {
      '+': () => zoom(1.5),
      '-': () => zoom(1 / 1.5),
      '0': () => fit(picture, canvas.current!),
      '1': () => zoom(1 / view.zoom),
      ArrowLeft: () => move(60, 0),
      ArrowRight: () => move(-60, 0),
      ArrowUp: () => move(0, 60),
      ArrowDown: () => move(0, -60),
    };
    const next = moves[event.key]?.();
    if (!next) return;
    event.preventDefault();
    setView(next);
  };
  useEffect(() => {
    const element = canvas.current!;
    const wheel = (event: WheelEvent) => {
      if (!view) return;
      event.preventDefault();
      const [x, y] = placeIn(event);
      setView(zoomAt(view, Math.exp(-event.deltaY / 400), x, y, least()));
    };
    element.addEventListener('wheel', wheel, { passive: false });
    return () => element.removeEventListener('wheel', wheel);
  });
  return { onPointerDown, onPointerMove, onPointerUp, onPointerCancel: onPointerUp, onKeyDown };
}
