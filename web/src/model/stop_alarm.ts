/** The alarm for a drive that acknowledges a stop and does not slow down. */
import type { Rig } from '../api/types';

export type StopAlarm = 'off' | 'loud' | 'acknowledged';

/** The alarm after a new state of the rig. It is loud again if the axis moves again after it was at rest. */
export function nextAlarm(alarm: StopAlarm, before: Rig | undefined, now: Rig): StopAlarm {
  if (now.cause !== 'STOP_NOT_OBEYED') return 'off';
  const isNew = before?.cause !== now.cause;
  const movesAgain = now.state === 'STOPPING' && before?.state !== 'STOPPING';
  return isNew || movesAgain ? 'loud' : alarm;
}
