/** How the texture comes to the surface of a model without texture coordinates. */
import * as rules from '../../api/rules';
import { limitsOf } from '../../model/limits';
import type { Projection, ProjectionKind } from '../../model/projection';
import { Choice, NumberField } from '../../ui/controls';
import { change, draft, lacksCoordinates } from './draft';
import { arrangement } from './intake';

const kChoices: { value: ProjectionKind; label: string; how: string }[] = [
  { value: 'dip', label: 'From below (dip)', how: 'from below, as the film sees it' },
  {
    value: 'planar',
    label: 'From one direction (planar)',
    how: 'onto the underside of the model, whatever its pose',
  },
  {
    value: 'cylindrical',
    label: 'Around (cylindrical)',
    how: 'from all around, about the z axis of the model',
  },
  {
    value: 'box',
    label: 'From three sides (box)',
    how: 'along the three axes of the model, and blended where they meet',
  },
];

const kOther = {
  uv: 'by the texture coordinates of the model',
  decal: 'as a decal',
} as const;

const choose = (part: Partial<Projection>) =>
  change({ projection: { ...draft.value.projection, ...part } });

/** The choice of the projection; nothing if the texture is not projected. */
export function ProjectionPanel() {
  const { projection, from } = draft.value;
  const hasTexture = arrangement.value.texture !== undefined || from?.spec.texture !== undefined;
  if (!hasTexture || !(lacksCoordinates.value || projection.kind)) return null;
  const { kind = 'dip', size_mm, turn_deg } = projection;
  return (
    <>
      <p class="note" role="status">
        <Note kind={kind} />
      </p>
      <Choice<ProjectionKind>
        label="Projection of the picture"
        value={kind}
        onValue={(value) => choose({ kind: value })}
        choices={choicesWith(kind)}
      />
      <div class="row">
        <NumberField
          label="Width of the picture"
          {...limitsOf(rules.SimulateSpec.projectSizeMm)}
          min={kLeastWidth_mm}
          placeholder="fitted"
          value={size_mm}
          onValue={(value) => choose({ size_mm: value })}
          onEmpty={() => choose({ size_mm: undefined })}
        />
        <NumberField
          label="Turn of the picture"
          {...limitsOf(rules.SimulateSpec.projectTurnDeg)}
          value={turn_deg}
          onValue={(value) => choose({ turn_deg: value })}
          onEmpty={() => choose({ turn_deg: undefined })}
        />
      </div>
    </>
  );
}

// The API allows any width above 0.
const kLeastWidth_mm = 0.1;

/** The choices, with the projection of a job if it is another one. */
const choicesWith = (kind: ProjectionKind) =>
  kind === 'uv' || kind === 'decal'
    ? [...kChoices, { value: kind, label: kind === 'uv' ? 'Texture coordinates' : 'Decal' }]
    : kChoices;

function Note({ kind }: { kind: ProjectionKind }) {
  const how =
    kind === 'uv' || kind === 'decal'
      ? kOther[kind]
      : kChoices.find(({ value }) => value === kind)!.how;
  const isShown = lacksCoordinates.value && (kind === 'dip' || kind === 'planar');
  return (
    <>
      {lacksCoordinates.value
        ? `This model has no texture coordinates: the picture is projected ${how}.`
        : `The picture is projected ${how}.`}
      {!isShown && ' The 3D view here does not show it; the result does.'}
    </>
  );
}
