/**
 * What happens at the daemon, as it happens: one stream for the page. A connection that breaks is made again, and
 * what was missed meanwhile is asked for, so that the page is right without a reload.
 */
import { signal } from '@preact/signals';
import { address } from './api/call';

export type Link = 'connecting' | 'live' | 'lost';

/** How the connection to the daemon is. */
export const link = signal<Link>('connecting');

/** Counts how often the stream began: whoever shows something asks for it anew then. */
export const beginnings = signal(0);

type Listener = (data: unknown) => void;
const listeners = new Map<string, Set<Listener>>();

/** Calls `listener` with each event of that topic ("job", "rig", "queue"); returns how to end that. */
export function on(topic: string, listener: Listener): () => void {
  const all = listeners.get(topic) ?? new Set();
  listeners.set(topic, all);
  all.add(listener);
  return () => all.delete(listener);
}

const kTopics = ['job', 'rig', 'queue'];
const kFirstWait_ms = 500;
const kLongestWait_ms = 10_000;
// The rig is told of every 2 s at least; so long without a word, and the connection is dead.
const kSilence_ms = 12_000;

let source: EventSource | undefined;
let wait_ms = kFirstWait_ms;
let timer: number | undefined;
let heard = 0;

/** Opens the stream, and keeps it open. */
export function connect(): void {
  window.clearTimeout(timer);
  source?.close();
  heard = Date.now();
  const opened = new EventSource(address('events:watch', { topics: kTopics }));
  source = opened;
  opened.onopen = () => {
    heard = Date.now();
    wait_ms = kFirstWait_ms;
    link.value = 'live';
    beginnings.value += 1;
  };
  // While CONNECTING the browser tries by itself, from the last id on; CLOSED it gave up.
  opened.onerror = () => {
    link.value = 'lost';
    if (opened.readyState === EventSource.CLOSED) again();
  };
  for (const topic of kTopics) opened.addEventListener(topic, (event) => take(topic, event));
}

/** Ends the stream, as when somebody signs out. */
export function disconnect(): void {
  window.clearTimeout(timer);
  source?.close();
  source = undefined;
  link.value = 'connecting';
}

function again(): void {
  window.clearTimeout(timer);
  timer = window.setTimeout(connect, wait_ms);
  wait_ms = Math.min(2 * wait_ms, kLongestWait_ms);
}

function take(topic: string, event: MessageEvent<string>): void {
  heard = Date.now();
  if (link.value !== 'live') link.value = 'live';
  let news: unknown;
  try {
    news = (JSON.parse(event.data) as Record<string, unknown>)[topic];
  } catch {
    return;
  }
  if (news !== undefined) for (const listener of listeners.get(topic) ?? []) listener(news);
}

function checkSilence(): void {
  if (!source || document.hidden || Date.now() - heard < kSilence_ms) return;
  link.value = 'lost';
  connect();
}

if (typeof window !== 'undefined') {
  window.setInterval(checkSilence, 3000);
  // A phone that was asleep, or a network that came back: at once, not when the wait is over.
  window.addEventListener('online', () => source && connect());
  document.addEventListener('visibilitychange', () => source && link.value === 'lost' && connect());
}
