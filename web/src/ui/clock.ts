import { signal } from '@preact/signals';
import { daemonNow } from '../api/call';

/** Now, by the daemon's clock; ticks four times a second while the page is seen. */
export const now = signal(daemonNow());

if (typeof window !== 'undefined')
  window.setInterval(() => {
    if (!document.hidden) now.value = daemonNow();
  }, 250);

/** Seconds from now until `time`; undefined without one. */
export const secondsUntil = (time: string | undefined): number | undefined =>
  time ? (Date.parse(time) - now.value.getTime()) / 1000 : undefined;
