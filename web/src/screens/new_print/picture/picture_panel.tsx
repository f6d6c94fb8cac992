/** The picture on the object: its projection, and its place and size as numbers. */
import { change, draft, lacksCoordinates, layer } from '../draft';
import { arrangement } from '../intake';
import { isPlaced, withProjection } from './choices';
import { isAboveOwnColours, pictureOf } from './spec';
import { isUndecodable, texturePicture } from './decoded';
import { DirectionChoice } from './direction_choice';
import { Numbers, Unplaced } from './layer_fields';
import { placement, rotation } from './placed';
import { howOf, ProjectionChoice } from './projection_choice';

/** Nothing if there is no picture. */
export function PicturePanel() {
  const { from } = draft.value;
  const { texture } = arrangement.value;
  const known = from && pictureOf(from.spec);
  if (from && !known && !texture) return <Foreign />;
  if (!texture && !known?.texture) return null;
  return (
    <div class="picture" role="group" aria-labelledby="picture-title">
      <h3 id="picture-title">Picture</h3>
      <Projection />
      {isPlaced(layer.value.projection) ? (
        <>
          <DirectionChoice />
          <Numbers />
        </>
      ) : (
        <Unplaced />
      )}
    </div>
  );
}

/** The paint of a job that was made elsewhere. */
const Foreign = () => (
  <p class="note">
    The picture of this job has parts that this page cannot change. They stay as they are. To
    replace them, drop a picture.
  </p>
);

function Projection() {
  const { projection } = layer.value;
  const choose = (next: typeof projection) =>
    change({ layer: withProjection(draft.value.layer, next, rotation.value) });
  return (
    <>
      <ProjectionChoice
        value={projection}
        lacksCoordinates={lacksCoordinates.value}
        onValue={choose}
      />
      <p class="quiet" role="status">
        {wayAround() ?? howOf(projection)}
        {isAboveOwnColours(layer.value, arrangement.value.hasOwnColours) &&
          ' Around it, the model keeps its own colours.'}
        {isUndecodable.value && ' This browser cannot show the picture here; the result shows it.'}
      </p>
    </>
  );
}

/** How often a picture goes around the object; undefined if it does not, or if its size is unknown. */
function wayAround(): string | undefined {
  const now = placement.value;
  if (now?.projection !== 'cylindrical' || !now.repeat || !texturePicture.value) return undefined;
  const times = Math.round((2 * Math.PI * now.radius_mm) / now.width_mm);
  return `The picture goes around the object ${times === 1 ? 'once' : `${times} times`}.`;
}
