/** The alarm for a stop that is not obeyed. It follows the rig's state, which every page receives. */
import { effect, signal } from '@preact/signals';
import type { Rig } from '../api/types';
import { nextAlarm, type StopAlarm } from '../model/stop_alarm';
import { rig } from './rig';

export const stopAlarm = signal<StopAlarm>('off');

let before: Rig | undefined;

effect(() => {
  const now = rig.value;
  if (now) stopAlarm.value = nextAlarm(stopAlarm.peek(), before, now);
  before = now;
});

/** Silences the alarm. It stays visible until its cause is gone. */
export const acknowledge = (): void => {
  if (stopAlarm.value === 'loud') stopAlarm.value = 'acknowledged';
};
