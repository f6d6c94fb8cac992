/** The dipped object in 3D. */
import { useEffect, useRef, useState } from 'preact/hooks';
import type { Warning } from '../../api/types';
import type { Scale } from '../../model/colour_map';
import { rotate, type Quaternion } from '../../model/pose';
import { placesOf } from '../../model/surface_map';
import { Switch } from '../../ui/controls';
import { Legend } from '../../ui/legend';
import type { Mode, ResultView, Start } from '../../view3d/result_view';
import type { Side } from '../../view3d/stage';
import type { Results } from './results';

interface Props {
  results: Results;
  /** The selected warning. */
  pointed: Warning | undefined;
  /** Called with the view once it is ready and has the film image. */
  onView?: (view: ResultView) => void;
}

/** Pose of the object at first contact, when its lowest point is on the water. */
export function startOf(results: Results): Start | undefined {
  const pose = results.dip?.pose;
  const map = results.map.value;
  if (!pose || !map) return undefined;
  const [w = 1, x = 0, y = 0, z = 0] = pose.rotationWxyz;
  const rotation: Quaternion = [w, x, y, z];
  const ups = (
    [
      [1, 0, 0],
      [0, 1, 0],
      [0, 0, 1],
    ] as const
  ).map((axis) => rotate(rotation, axis)[2]);
  let lowest = Infinity;
  const { positions } = map;
  for (let i = 0; i < positions.length; i += 3)
    lowest = Math.min(
      lowest,
      ups[0]! * positions[i]! + ups[1]! * positions[i + 1]! + ups[2]! * positions[i + 2]!,
    );
  const [tx = 0, ty = 0] = pose.translationMm;
  return { rotation, translation_mm: [tx, ty, -lowest] };
}

/** The stretch at which the film tears; the upper end of the scale. */
const tearOf = (results: Results): number => results.dip?.profile?.tearStretch ?? 3;

/** Scale of the stated error on the film, mm; about a pixel at 300 dpi is in its middle. */
const kError: Scale = { map: 'viridis', min: 0.01, max: 1, log: true };

export function ObjectViewer({ results, pointed, onView }: Props) {
  const host = useRef<HTMLDivElement>(null);
  const [view, setView] = useState<ResultView>();
  const [trouble, setTrouble] = useState('');
  const [mode, setMode] = useState<Mode>('predicted');
  const [time, setTime] = useState(Infinity);
  const map = results.map.value;
  const film = results.film.value;

  useEffect(() => {
    results.loadMap();
    results.loadFilm();
  }, [results]);

  useEffect(() => {
    const start = startOf(results);
    const shape = results.filmShape();
    if (!map || !start || !shape) return undefined;
    let made: ResultView | undefined;
    let isGone = false;
    void import('../../view3d/result_view').then(({ ResultView: View }) => {
      if (isGone || !host.current) return;
      const speed = results.dip?.dipSpeedMmPerS ?? 5;
      try {
        made = new View(host.current, map, start, shape, speed);
      } catch {
        setTrouble(
          'This browser cannot show 3D because WebGL is off or missing. See the images under Files.',
        );
        return;
      }
      setView(made);
    });
    return () => {
      isGone = true;
      made?.dispose();
      setView(undefined);
    };
  }, [map]);

  useEffect(() => {
    if (!view || !film) return;
    view.setPicture(film.picture);
    onView?.(view);
  }, [view, film]);

  const tear = tearOf(results);
  const stretch: Scale = { map: 'viridis', min: 1, max: tear, log: true };
  const contact: Scale = { map: 'cividis', min: 0, max: map?.contactMax_s || 1 };
  const end_s = map?.contactMax_s ?? 0;
  const shown_s = Math.min(time, end_s);
  useEffect(() => {
    if (!view || !map) return;
    if (mode === 'predicted') view.showPredicted();
    if (mode === 'stretch') view.showValues(map.stretch, stretch);
    if (mode === 'error' && map.error_mm) view.showValues(map.error_mm, kError);
    if (mode === 'contact') view.showContact(shown_s, contact);
  }, [view, mode, shown_s]);

  useEffect(() => {
    if (!view || !map) return;
    const point = pointed?.where?.filmPoint;
    const place = point && ([point.xMm, point.yMm, point.immersionMm] as const);
    view.point(pointed ? placesOf(pointed.code, map) : [], place);
  }, [view, pointed]);

  return (
    <div class="view3d">
      <div class="stage" ref={host} role="img" aria-label={`The object, ${kWords[mode]}`} />
      {!view && !trouble && <p class="quiet waiting">Fetching the surface map…</p>}
      {trouble && <p class="trouble">{trouble}</p>}
      <div class="tools">
        <Switch<Mode>
          label="Colouring"
          value={mode}
          onValue={(next) => {
            setMode(next);
            // The waterline is best visible from the corner and without marks.
            if (next === 'contact') {
              view?.point([]);
              view?.look('corner');
            }
          }}
          choices={[
            { value: 'predicted', label: 'Predicted' },
            { value: 'stretch', label: 'Stretch' },
            ...(map?.error_mm ? [{ value: 'error' as const, label: 'Error' }] : []),
            { value: 'contact', label: 'Contact time' },
          ]}
        />
        <span class="group" role="group" aria-label="View from">
          {(['corner', 'front', 'right', 'top', 'below'] as const).map((side: Side) => (
            <button type="button" class="plain" key={side} onClick={() => view?.look(side)}>
              {side[0]!.toUpperCase() + side.slice(1)}
            </button>
          ))}
        </span>
      </div>
      {mode === 'stretch' && (
        <Legend
          title="Stretch of the film"
          unit="×"
          scale={stretch}
          values={[1, 1.3, 1.6, 2, 2.5, 3, 4, 6].filter((value) => value < tear).concat(tear)}
          beyond="the film tears"
        />
      )}
      {mode === 'error' && (
        <Legend
          title="Stated error of the place on the film"
          unit="mm"
          scale={kError}
          values={[0.01, 0.03, 0.1, 0.3, 1]}
          beyond="not known"
        />
      )}
      {mode === 'contact' && map && (
        <>
          <Player end_s={end_s} time_s={shown_s} onTime={setTime} />
          <Legend title="Contact time" unit="s" scale={contact} />
        </>
      )}
      {pointed && mode !== 'contact' && (
        <p class="quiet">Pink marks the location of the selected warning.</p>
      )}
    </div>
  );
}

const kWords: Record<Mode, string> = {
  predicted: 'as predicted after the dip',
  stretch: 'coloured by the stretch of the film',
  error: 'coloured by the stated error of the place on the film',
  contact: 'coloured by contact time',
};

/** Animates the rising waterline. */
function Player(props: { end_s: number; time_s: number; onTime: (time_s: number) => void }) {
  const { end_s, time_s, onTime } = props;
  const [isPlaying, setPlaying] = useState(false);
  const at = useRef(time_s);
  at.current = time_s;
  useEffect(() => {
    if (!isPlaying) return undefined;
    let frame = 0;
    let last = performance.now();
    const step = (now: number) => {
      const next = at.current + (now - last) / 1000;
      last = now;
      onTime(Math.min(next, end_s));
      if (next < end_s) frame = requestAnimationFrame(step);
      else setPlaying(false);
    };
    frame = requestAnimationFrame(step);
    return () => cancelAnimationFrame(frame);
  }, [isPlaying]);
  const toggle = () => {
    if (!isPlaying && time_s >= end_s) onTime(0);
    setPlaying(!isPlaying);
  };
  return (
    <div class="player">
      <button type="button" onClick={toggle}>
        {isPlaying ? 'Pause' : 'Play'}
      </button>
      <input
        type="range"
        min={0}
        max={Math.ceil(10 * end_s) / 10}
        step={0.1}
        value={time_s}
        aria-label="Time since first contact"
        aria-valuetext={`${time_s.toFixed(1)} s`}
        onInput={(event) => onTime(Number(event.currentTarget.value))}
      />
      <span class="readout">{time_s.toFixed(1)} s</span>
    </div>
  );
}
