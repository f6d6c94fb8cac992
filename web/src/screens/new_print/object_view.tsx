/** The object over the film in 3D. The code for 3D is loaded only when it is needed. */
import { computed, effect, signal } from '@preact/signals';
import { useEffect, useRef, useState } from 'preact/hooks';
import type { PoseView } from '../../view3d/pose_view';
import type { Side } from '../../view3d/stage';
import { colourOf, place, type Scale } from '../../model/colour_map';
import type { Paint } from '../../paint/paint';
import { Switch } from '../../ui/controls';
import { Legend } from '../../ui/legend';
import { calibrated } from './calibration';
import { change, film, layer, shape } from './draft';
import { arrangement } from './intake';
import { looks, mode, setMode, view, type Mode } from './mode';
import { decoded, followPicture, texturePicture } from './picture/decoded';
import { isMovable, pose, scale, surroundings } from './picture/placed';
import { listen } from './picture/pointer_input';
import { isAboveOwnColours } from './picture/spec';
import { shown, type Shown } from './preview';
import { UndoButtons } from './undo_buttons';

const chosenCoat = signal<'picture' | 'stretch'>('picture');
/** The picture is shown while it is moved. */
const coat = computed(() => (mode.value === 'picture' ? 'picture' : chosenCoat.value));
const kStretch: Scale = { map: 'viridis', min: 1, max: 3, log: true };

/** The object's texture as a layer. */
function paintOf(): Paint | undefined {
  const picture = texturePicture.value;
  if (!picture) return undefined;
  const top = { layer: layer.value, picture };
  const hasBelow = isAboveOwnColours(layer.value, arrangement.value.hasOwnColours);
  return { layers: [...(hasBelow ? [{ layer: { projection: 'uv' as const } }] : []), top] };
}

export function ObjectView() {
  const host = useRef<HTMLDivElement>(null);
  const [trouble, setTrouble] = useState('');

  useEffect(() => {
    let isGone = false;
    let end = () => {};
    void import('../../view3d/pose_view').then(({ PoseView: View }) => {
      if (isGone || !host.current) return;
      try {
        view.value = new View(host.current, {
          onPose: (turned) => change({ pose: turned }),
          onLook: () => (looks.value = looks.peek() + 1),
        });
      } catch {
        setTrouble(
          'This browser cannot show 3D because WebGL is off or missing. Enter the rotation as numbers; everything else works.',
        );
        return;
      }
      end = follow(view.value, host.current);
    });
    return () => {
      isGone = true;
      end();
      view.value?.dispose();
      view.value = undefined;
    };
  }, []);
  useEffect(followPicture, []);

  const look = (side: Side) => view.value?.look(side, film.value);
  return (
    <div class="view3d">
      <div
        class="stage"
        ref={host}
        role="img"
        aria-label="3D view of the object above the film. The fields beside this view place the object and its picture."
      />
      {trouble && <p class="trouble">{trouble}</p>}
      <div class="tools">
        <Switch<Mode>
          label="Effect of dragging"
          value={mode.value}
          onValue={setMode}
          choices={[
            { value: 'rotate', label: 'Turn' },
            { value: 'translate', label: 'Move' },
            ...(isMovable.value ? [{ value: 'picture' as const, label: 'Picture' }] : []),
            { value: 'none', label: 'View' },
          ]}
        />
        <UndoButtons />
        {shown.value && mode.value !== 'picture' && (
          <Switch<'picture' | 'stretch'>
            label="Texture"
            value={coat.value}
            onValue={(value) => (chosenCoat.value = value)}
            choices={[
              { value: 'picture', label: 'Image' },
              { value: 'stretch', label: 'Stretch' },
            ]}
          />
        )}
        <span class="group" role="group" aria-label="View from">
          {(['corner', 'front', 'right', 'top', 'below'] as const).map((side) => (
            <button type="button" class="plain" key={side} onClick={() => look(side)}>
              {side[0]!.toUpperCase() + side.slice(1)}
            </button>
          ))}
          <button type="button" class="plain" onClick={() => view.value?.closeUp()}>
            Close-up
          </button>
        </span>
      </div>
      {mode.value === 'picture' && <Hint />}
      {shown.value && coat.value === 'stretch' && (
        <Legend
          title="Stretch of the film (estimate)"
          unit="×"
          scale={kStretch}
          values={[1, 1.3, 1.6, 2, 2.5, 3]}
          beyond="most films tear"
        />
      )}
    </div>
  );
}

/** How the picture is moved. */
const Hint = () => (
  <p class="quiet hint">
    Drag to move the picture. Scroll or pinch to change its size. Shift-drag or twist with two
    fingers to turn it.
  </p>
);

/** Builds the mesh for the preview's stretch colours. */
function heatOf({ positions, corners, stretch }: Shown) {
  const colours = new Uint8Array(positions.length);
  for (let i = 0; i < stretch.length; i += 1)
    colours.set(colourOf(kStretch.map, place(kStretch, stretch[i]!)), 3 * i);
  return { positions, corners, colours };
}

/** Keeps the view up to date with the draft and the preview. */
function follow(view: PoseView, host: HTMLElement): () => void {
  const ends = [
    effect(() => {
      view.setFilm(film.value);
    }),
    effect(() => {
      const now = shape.value;
      if (!now) return view.clear();
      // The texture of a new object is decoded first, so that it is shown only once.
      if (decoded.value.of !== arrangement.value) return;
      view.setMesh(now.mesh, now.box, scale.value);
      view.setPose(pose.peek());
      const seen = shown.peek();
      view.setHeat(seen && coat.peek() === 'stretch' ? heatOf(seen) : undefined);
    }),
    effect(() => {
      view.setPaint(paintOf());
    }),
    effect(() => {
      view.setPose(pose.value);
    }),
    effect(() => {
      view.setGizmo(calibrated.value || mode.value === 'picture' ? 'none' : mode.value);
    }),
    effect(() => {
      view.setHeat(shown.value && coat.value === 'stretch' ? heatOf(shown.value) : undefined);
    }),
    effect(() =>
      mode.value === 'picture'
        ? listen(
            host,
            surroundings((x, y) => view.hit(x, y)),
          )
        : undefined,
    ),
    // Resets the camera when the object, its scale or the film changes, but not while the object is rotated.
    effect(() => {
      void shape.value;
      void scale.value;
      view.look('corner', film.value);
    }),
  ];
  return () => ends.forEach((end) => end());
}
