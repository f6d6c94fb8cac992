/** Poses measured by calibrations. */
import { computed, signal } from '@preact/signals';
import { calibrations as api } from '../../api/services';
import type { Calibration } from '../../api/types';
import { fromApi, type Pose } from '../../model/pose';
import { orNotify } from '../../state/notices';
import { centre_mm, draft } from './draft';

/** Calibrations of objects (not of cameras), newest first. */
export const calibrations = signal<Calibration[]>([]);

export async function refreshCalibrations(): Promise<void> {
  const page = orNotify(await api.list());
  if (page) calibrations.value = page.calibrations.filter(({ kind }) => kind === 'OBJECT');
}

/** The selected calibration and its pose. */
export const calibrated = computed<{ calibration: Calibration; pose: Pose } | undefined>(() => {
  const name = draft.value.calibration;
  const calibration = calibrations.value.find((one) => one.name === name);
  const pose = fromApi(calibration?.pose, centre_mm.value);
  return calibration && pose ? { calibration, pose } : undefined;
});

const kStale: Record<string, string> = {
  MOVED: 'the axis has moved since the calibration',
  HOMED: 'the rig has been homed since the calibration, or has lost its position',
  DIPPED: 'an object has been dipped since the calibration',
};

/** Describes why the calibration is no longer valid; empty if it is valid. */
export const staleness = (calibration: Calibration): string =>
  (calibration.stale ?? []).map((why) => kStale[why] ?? why).join('; ');
