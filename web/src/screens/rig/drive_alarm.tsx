import type { Rig } from '../../api/types';

/** The drive's own alarm: its number, with the text of the drive's profile. */
export function DriveAlarm({ now: { alarmCode, alarmText } }: { now: Rig }) {
  if (!alarmCode) return null;
  return (
    <p class="warning">
      Alarm {alarmCode} of the drive{alarmText && `: ${alarmText}`}
    </p>
  );
}
