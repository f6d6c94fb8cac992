/** Where the picture is on the object, from the draft. */
import { computed } from '@preact/signals';
import { attempt } from '../../../model/result';
import { place, type Placement, type Solid } from '../../../paint/placement';
import { calibrated } from '../calibration';
import { change, draft, layer, shape } from '../draft';
import { arrangement } from '../intake';
import { isPlaced, onlyChosen, type LayerChoices } from './choices';
import { texturePicture } from './decoded';
import type { Surroundings } from './gestures';

/** Changes the layer by these options; undefined removes an option. */
export const choose = (part: LayerChoices): void =>
  change({ layer: onlyChosen({ ...draft.value.layer, ...part }) });

// Separate from the draft, so that other changes of the draft keep the placement.
export const scale = computed(() => draft.value.scale);
/** The object's pose, from the draft or a calibration. */
export const pose = computed(() => calibrated.value?.pose ?? draft.value.pose);
export const rotation = computed(() => pose.value.rotation);

const solid = computed<Solid | undefined>(
  () => shape.value && { ...shape.value.mesh, scale: scale.value },
);

/** The place of the layer; undefined if it has none, or if its directions do not give one. */
export const placement = computed<Placement | undefined>(() => {
  const mesh = solid.value;
  if (!mesh || !isPlaced(layer.value.projection)) return undefined;
  const { width, height } = texturePicture.value ?? { width: 1, height: 1 };
  const placed = attempt(() => place(layer.value, mesh, rotation.value, width / height));
  return placed.ok ? placed.value : undefined;
});

/** True if there is a picture on the object that can be moved. */
export const isMovable = computed(
  () => arrangement.value.texture !== undefined && placement.value !== undefined,
);

/** The part of the page that gestures change. */
export const surroundings = (hit: Surroundings['hit']): Surroundings => ({
  hit,
  current: () =>
    placement.value && {
      layer: layer.value,
      placement: placement.value,
      rotation_FO: rotation.value,
    },
  change: choose,
});
