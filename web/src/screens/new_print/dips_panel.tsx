import * as dips from '../../model/dips';
import type { Pose } from '../../model/pose';
import { toAngles } from '../../model/pose';
import { formatFactor, formatShare } from '../../model/units';
import { calibrated } from './calibration';
import { change, draft } from './draft';
import { figuresOf } from './preview';

/** The dips among which the picture is divided; nothing for a print of one dip. */
export function DipList() {
  const poses = dips.posesOf(draft.value);
  if (poses.length === 1) return null;
  return (
    <ol class="files dips">
      {poses.map((pose, k) => (
        <Dip key={k} pose={pose} at={k} />
      ))}
    </ol>
  );
}

export function AddDip() {
  if (calibrated.value) return null;
  const count = dips.posesOf(draft.value).length;
  return (
    <>
      <button
        type="button"
        disabled={count >= dips.kMostDips}
        onClick={() => change(dips.add(draft.value))}
      >
        Add another dip
      </button>
      <p class="quiet">
        {count > 1
          ? `Each place is printed by the dip that stretches the film least there. At most ${dips.kMostDips} dips.`
          : 'For sides that the film does not reach in this pose.'}
      </p>
    </>
  );
}

function Dip({ pose, at }: { pose: Pose; at: number }) {
  const isSelected = at === draft.value.before.length;
  return (
    <li>
      <button
        type="button"
        class="plain name"
        aria-pressed={isSelected}
        onClick={() => change(dips.select(draft.value, at))}
      >
        Dip {at + 1}
      </button>
      <span class="quiet">{figuresText(pose) ?? anglesText(pose)}</span>
      <button
        type="button"
        class="plain"
        aria-label={`Remove dip ${at + 1}`}
        onClick={() => change(dips.remove(draft.value, at))}
      >
        Remove
      </button>
    </li>
  );
}

/** The preview of a pose; undefined if there was none since the object or the film changed. */
function figuresText(pose: Pose): string | undefined {
  const figures = figuresOf(pose);
  return (
    figures && `reach ${formatShare(figures.coverage)}, stretch ${formatFactor(figures.stretchP95)}`
  );
}

const anglesText = (pose: Pose): string =>
  `turned ${toAngles(pose.rotation)
    .map((angle) => `${Math.round(angle)}°`)
    .join(', ')}`;
