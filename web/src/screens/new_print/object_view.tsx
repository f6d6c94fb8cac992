/** The object over the film in 3D. The code for 3D is loaded only when it is needed. */
import { computed, effect, signal } from '@preact/signals';
import { useEffect, useRef, useState } from 'preact/hooks';
import type { PoseView, Gizmo, Look } from '../../view3d/pose_view';
import type { Side } from '../../view3d/stage';
import { colourOf, place, type Scale } from '../../model/colour_map';
import { readPicture, type Paint } from '../../paint/paint';
import { Switch } from '../../ui/controls';
import { Legend } from '../../ui/legend';
import { calibrated } from './calibration';
import { change, draft, film, lacksCoordinates, shape } from './draft';
import { arrangement } from './intake';
import { shown, type Shown } from './preview';

const gizmo = signal<Gizmo>('rotate');
const coat = signal<'picture' | 'stretch'>('picture');
const kStretch: Scale = { map: 'viridis', min: 1, max: 3, log: true };
// Separate from the draft, so that rotating the object does not rebuild its mesh.
const scale = computed(() => draft.value.scale);
const pose = computed(() => calibrated.value?.pose ?? draft.value.pose);
const projection = computed(() => draft.value.projection);

/** Decoded images by file. Formats that the browser cannot display (TIFF) are skipped. */
async function pictures(): Promise<Map<File, ImageBitmap>> {
  const { materials, texture } = arrangement.value;
  const out = new Map<File, ImageBitmap>();
  const files = [texture, ...[...materials.values()].map((material) => material.file)];
  for (const file of files) {
    if (!file || out.has(file)) continue;
    const bitmap = await readPicture(file);
    if (bitmap) out.set(file, bitmap);
  }
  return out;
}

function lookOf(material: string, ready: Map<File, ImageBitmap>): Look {
  const known = arrangement.value.materials.get(material);
  const picture = known?.file && shape.value?.mesh.uvs && ready.get(known.file);
  if (picture) return { colour: [1, 1, 1], picture };
  return { colour: known?.colour ?? [0.85, 0.85, 0.85] };
}

/** The object's texture as a layer. */
function paintOf(ready: Map<File, ImageBitmap>): Paint | undefined {
  const { texture } = arrangement.value;
  const picture = texture && ready.get(texture);
  if (!picture) return undefined;
  const { kind = lacksCoordinates.value ? 'dip' : 'uv', ...rest } = projection.value;
  return { layers: [{ layer: { projection: kind, ...rest }, picture }] };
}

export function ObjectView() {
  const host = useRef<HTMLDivElement>(null);
  const view = useRef<PoseView>();
  const [trouble, setTrouble] = useState('');

  useEffect(() => {
    let isGone = false;
    let end = () => {};
    void import('../../view3d/pose_view').then(({ PoseView: View }) => {
      if (isGone || !host.current) return;
      try {
        view.current = new View(host.current, (turned) => change({ pose: turned }));
      } catch {
        setTrouble(
          'This browser cannot show 3D because WebGL is off or missing. Enter the rotation as numbers; everything else works.',
        );
        return;
      }
      end = follow(view.current);
    });
    return () => {
      isGone = true;
      end();
      view.current?.dispose();
      view.current = undefined;
    };
  }, []);

  const look = (side: Side) => view.current?.look(side, film.value);
  return (
    <div class="view3d">
      <div
        class="stage"
        ref={host}
        role="img"
        aria-label="3D view of the object above the film. The fields beside this view turn and move the object."
      />
      {trouble && <p class="trouble">{trouble}</p>}
      <div class="tools">
        <Switch<Gizmo>
          label="Effect of dragging"
          value={gizmo.value}
          onValue={(value) => (gizmo.value = value)}
          choices={[
            { value: 'rotate', label: 'Turn' },
            { value: 'translate', label: 'Move' },
            { value: 'none', label: 'View' },
          ]}
        />
        {shown.value && (
          <Switch<'picture' | 'stretch'>
            label="Texture"
            value={coat.value}
            onValue={(value) => (coat.value = value)}
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
        </span>
      </div>
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

/** Builds the mesh for the preview's stretch colours. */
function heatOf({ positions, corners, stretch }: Shown) {
  const colours = new Uint8Array(positions.length);
  for (let i = 0; i < stretch.length; i += 1)
    colours.set(colourOf(kStretch.map, place(kStretch, stretch[i]!)), 3 * i);
  return { positions, corners, colours };
}

/** Keeps the view up to date with the draft and the preview. */
function follow(view: PoseView): () => void {
  let count = 0;
  const ends = [
    effect(() => {
      view.setFilm(film.value);
    }),
    effect(() => {
      const now = shape.value;
      const factor = scale.value;
      void arrangement.value;
      void projection.value;
      count += 1;
      const turn = count;
      if (!now) return view.clear();
      return void pictures().then((ready) => {
        if (turn !== count) return;
        view.setPaint(paintOf(ready));
        view.setMesh(now.mesh, now.box, factor, (material) => lookOf(material, ready));
        view.setPose(pose.peek());
        view.setHeat(shown.value && coat.peek() === 'stretch' ? heatOf(shown.value) : undefined);
      });
    }),
    effect(() => {
      view.setPose(pose.value);
    }),
    effect(() => {
      view.setGizmo(calibrated.value ? 'none' : gizmo.value);
    }),
    effect(() => {
      view.setHeat(shown.value && coat.value === 'stretch' ? heatOf(shown.value) : undefined);
    }),
    // Resets the camera when the object, its scale or the film changes, but not while the object is rotated.
    effect(() => {
      void shape.value;
      void scale.value;
      view.look('corner', film.value);
    }),
  ];
  return () => ends.forEach((end) => end());
}
