import { signal } from '@preact/signals';
import { daemonNow } from '../api/call';

/** The current time by the daemon's clock, updated four times a second while the page is visible. */
export const now = signal(daemonNow());

if (typeof window !== 'undefined')
  window.setInterval(() => {
    if (!document.hidden) now.value = daemonNow();
  }, 250);

/** Seconds from now until `time`; undefined if `time` is. */
export const secondsUntil = (time: string | undefined): number | undefined =>
  time ? (Date.parse(time) - now.value.getTime()) / 1000 : undefined;
