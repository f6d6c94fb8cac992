/** Where the object hangs as a calibration measured it. */
import { computed, signal } from '@preact/signals';
import { calibrations as api } from '../../api/services';
import type { Calibration } from '../../api/types';
import { fromApi, type Pose } from '../../model/pose';
import { orComplain } from '../../state/notices';
import { centre_mm, draft } from './draft';

/** Those of objects, newest first. */
export const calibrations = signal<Calibration[]>([]);

export async function refreshCalibrations(): Promise<void> {
  const page = orComplain(await api.list());
  if (page) calibrations.value = page.calibrations.filter(({ kind }) => kind === 'OBJECT');
}

/** The one that was chosen, with the pose it found. */
export const calibrated = computed<{ calibration: Calibration; pose: Pose } | undefined>(() => {
  const name = draft.value.calibration;
  const calibration = calibrations.value.find((one) => one.name === name);
  const pose = fromApi(calibration?.pose, centre_mm.value);
  return calibration && pose ? { calibration, pose } : undefined;
});

const kStale: Record<string, string> = {
  MOVED: 'the axis is not where it was when it was measured',
  HOMED: 'the rig was homed since',
  DIPPED: 'something was dipped since',
};

/** Why it does not hold any more, in words; empty if it does. */
export const staleness = (calibration: Calibration): string =>
  (calibration.stale ?? []).map((why) => kStale[why] ?? why).join('; ');
