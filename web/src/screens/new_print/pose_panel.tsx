import { inputOf } from '../../model/fields';
import { fromAngles, kUpright, product, toAngles, turn, type Vec3 } from '../../model/pose';
import { formatMm } from '../../model/units';
import { Choice, NumberField } from '../../ui/controls';
import { useRefusal } from '../../ui/field_errors';
import { WarningLines } from '../../ui/warning';
import { calibrated, calibrations, staleness } from './calibration';
import { AddDip, DipList } from './dips_panel';
import { change, draft, selectedDip, shape } from './draft';

const kAxes = ['x', 'y', 'z'] as const;

/** The pose of the object: entered as numbers, in steps of 90°, or taken from a calibration. */
export function PosePanel() {
  if (!shape.value) return null;
  const dip = selectedDip();
  return (
    <section aria-labelledby="pose-title">
      <h2 id="pose-title">2 {inputOf('pose', dip).label}</h2>
      {dip === undefined ? <From /> : <DipList />}
      {calibrated.value ? <Measured /> : <ByHand key={dip} />}
      <AddDip />
    </section>
  );
}

function From() {
  if (calibrations.value.length === 0) return null;
  return (
    <Choice
      {...inputOf('calibration')}
      value={draft.value.calibration}
      onValue={(calibration) => change({ calibration })}
      choices={[
        { value: '', label: 'Manual' },
        ...calibrations.value.map((one) => ({
          value: one.name,
          label: `Measured: ${one.displayName || one.name}${one.active ? ' (active)' : ''}`,
        })),
      ]}
    />
  );
}

function Measured() {
  const { calibration } = calibrated.value!;
  const why = staleness(calibration);
  return (
    <>
      <p>
        Pose, film and scale come from the calibration
        {calibration.errorP95Mm !== undefined &&
          `. For 95 % of the surface, the error of this pose is at most ${formatMm(calibration.errorP95Mm, 2)}`}
        .
      </p>
      <WarningLines warnings={calibration.warnings} />
      {why && (
        <p class="warning">
          This calibration is no longer valid: {why}. Calibrate again, or enter the pose manually.
        </p>
      )}
    </>
  );
}

function ByHand() {
  const { pose } = draft.value;
  const problem = useRefusal({ name: 'pose', dip: selectedDip() }, pose);
  const errorId = problem && 'pose-error';
  const angles = toAngles(pose.rotation);
  const setAngle = (axis: number, degrees: number) => {
    const next = angles.map((angle, i) => (i === axis ? degrees : angle)) as unknown as Vec3;
    change({ pose: { ...pose, rotation: fromAngles(next) } });
  };
  const move = (axis: 0 | 1, mm: number) =>
    change({
      pose: { ...pose, centre_mm: axis === 0 ? [mm, pose.centre_mm[1]] : [pose.centre_mm[0], mm] },
    });
  return (
    <>
      <div class="row">
        {kAxes.map((axis, i) => (
          <NumberField
            key={axis}
            label={`Rotation about ${axis}`}
            unit="°"
            value={angles[i]}
            min={-360}
            max={360}
            errorId={errorId}
            onValue={(value) => setAngle(i, value)}
          />
        ))}
      </div>
      <div class="row">
        {kAxes.map((axis) => (
          <button
            type="button"
            key={axis}
            onClick={() =>
              change({ pose: { ...pose, rotation: product(turn(axis, 90), pose.rotation) } })
            }
          >
            +90° {axis}
          </button>
        ))}
      </div>
      <div class="row">
        <NumberField
          label="Offset to the right"
          unit="mm"
          value={pose.centre_mm[0]}
          min={-1000}
          max={1000}
          errorId={errorId}
          onValue={(mm) => move(0, mm)}
        />
        <NumberField
          label="Offset towards the top"
          unit="mm"
          value={pose.centre_mm[1]}
          min={-1000}
          max={1000}
          errorId={errorId}
          onValue={(mm) => move(1, mm)}
        />
        <button type="button" onClick={() => change({ pose: kUpright })}>
          Reset pose
        </button>
      </div>
      {problem && (
        <p class="error" id={errorId}>
          {problem}
        </p>
      )}
    </>
  );
}
