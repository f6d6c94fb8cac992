/** The numbers of the picture's layer. An empty field has the worker's default, which it shows. */
import * as rules from '../../../api/rules';
import { inputOf } from '../../../model/fields';
import { limitsOf } from '../../../model/limits';
import type { Vec3 } from '../../../model/pose';
import { Check, NumberField } from '../../../ui/controls';
import { change, draft, layer } from '../draft';
import { fitted, hasOption, repeatsByDefault } from './choices';
import { texturePicture } from './decoded';
import { kLeastSize_mm } from './move';
import { choose, placement } from './placed';

/** All options of a picture with a place. */
export const Numbers = () => (
  <>
    <Size />
    <Blending />
    <div class="row">
      <Check
        label="Mirror"
        value={layer.value.mirror ?? false}
        onValue={(mirror) => choose({ mirror: mirror || undefined })}
      />
      <Repeat />
      <button type="button" onClick={() => change({ layer: fitted(draft.value.layer) })}>
        Reset to fitted
      </button>
    </div>
    <details>
      <summary>More</summary>
      <Position />
    </details>
  </>
);

function Size() {
  const { size_mm, turn_deg } = layer.value;
  return (
    <div class="row">
      <NumberField
        {...inputOf('paint.layers.sizeMm')}
        {...limitsOf(rules.PaintLayer.sizeMm)}
        min={kLeastSize_mm}
        placeholder={fittedWidth()}
        value={size_mm}
        onValue={(value) => choose({ size_mm: value })}
        onEmpty={() => choose({ size_mm: undefined })}
      />
      <NumberField
        {...inputOf('paint.layers.turnDeg')}
        {...limitsOf(rules.PaintLayer.turnDeg)}
        value={turn_deg}
        onValue={(value) => choose({ turn_deg: value })}
        onEmpty={() => choose({ turn_deg: undefined })}
      />
    </div>
  );
}

/** The width that an empty field means. It depends on the picture, which must be known. */
const fittedWidth = (): string =>
  texturePicture.value && placement.value
    ? `fitted (${placement.value.width_mm.toFixed(1)})`
    : 'fitted';

const Depth = () => (
  <NumberField
    {...inputOf('paint.layers.depthMm')}
    {...limitsOf(rules.PaintLayer.depthMm)}
    min={kLeastSize_mm}
    placeholder="unlimited"
    value={layer.value.depth_mm}
    onValue={(value) => choose({ depth_mm: value })}
    onEmpty={() => choose({ depth_mm: undefined })}
  />
);

function Repeat() {
  const { projection, repeat } = layer.value;
  if (!hasOption(projection, 'repeat')) return null;
  const usual = repeatsByDefault(projection);
  return (
    <Check
      label="Repeat"
      value={repeat ?? usual}
      onValue={(value) => choose({ repeat: value === usual ? undefined : value })}
    />
  );
}

/** Opacity, and how a decal or the sides of a box end. */
function Blending() {
  const { projection } = layer.value;
  return (
    <div class="row">
      <Opacity />
      {hasOption(projection, 'depth_mm') && <Depth />}
      {hasOption(projection, 'blend_mm') && <Blend />}
    </div>
  );
}

/** The options of a picture that has no place of its own. */
export const Unplaced = () => (
  <div class="row">
    <Opacity />
    <Repeat />
  </div>
);

const kPercent = 100;

const Opacity = () => (
  <NumberField
    {...inputOf('paint.layers.opacity')}
    unit="%"
    min={0}
    max={kPercent}
    placeholder={String(kPercent)}
    value={layer.value.opacity === undefined ? undefined : kPercent * layer.value.opacity}
    onValue={(value) => choose({ opacity: value === kPercent ? undefined : value / kPercent })}
    onEmpty={() => choose({ opacity: undefined })}
  />
);

const Blend = () => (
  <NumberField
    {...inputOf('paint.layers.blendMm')}
    {...limitsOf(rules.PaintLayer.blendMm)}
    min={kLeastSize_mm}
    placeholder={placement.value?.blend_mm.toFixed(1) ?? 'fitted'}
    value={layer.value.blend_mm}
    onValue={(value) => choose({ blend_mm: value })}
    onEmpty={() => choose({ blend_mm: undefined })}
  />
);

const kFurthest_mm = 1e5;

/** The middle of the picture on the axes of the model. The three numbers are chosen together. */
function Position() {
  const { position_mm } = layer.value;
  const middle = placement.value?.position_mm ?? [0, 0, 0];
  const set = (axis: number, mm: number) => {
    const next = middle.map((value, i) => (i === axis ? mm : value)) as unknown as Vec3;
    choose({ position_mm: next });
  };
  return (
    <>
      <div class="row">
        {['x', 'y', 'z'].map((axis, i) => (
          <NumberField
            key={axis}
            label={`Position ${axis}`}
            unit="mm"
            min={-kFurthest_mm}
            max={kFurthest_mm}
            placeholder={middle[i]!.toFixed(1)}
            value={position_mm?.[i]}
            onValue={(value) => set(i, value)}
            onEmpty={() => choose({ position_mm: undefined })}
          />
        ))}
      </div>
      <p class="quiet">Middle of the picture, on the axes of the model.</p>
    </>
  );
}
