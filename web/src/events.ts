/**
 * The daemon's event stream, one for the whole page. A broken connection is opened again and the missed state is
 * fetched, so the page stays correct without a reload.
 */
import { signal } from '@preact/signals';
import { address } from './api/call';

export type Link = 'connecting' | 'live' | 'lost';

/** State of the connection to the daemon. */
export const link = signal<Link>('connecting');

/** Number of times that the stream was opened. Views fetch their data again when it changes. */
export const beginnings = signal(0);

type Listener = (data: unknown) => void;
const listeners = new Map<string, Set<Listener>>();

/** Calls `listener` with each event of the topic ("job", "rig", "queue"); returns a function that unsubscribes. */
export function on(topic: string, listener: Listener): () => void {
  const all = listeners.get(topic) ?? new Set();
  listeners.set(topic, all);
  all.add(listener);
  return () => all.delete(listener);
}

const kTopics = ['job', 'rig', 'queue'];
const kFirstWait_ms = 500;
const kLongestWait_ms = 10_000;
// The daemon sends the rig's state at least every 2 s. After 12 s without a message, the connection is considered dead.
const kSilence_ms = 12_000;

let source: EventSource | undefined;
let wait_ms = kFirstWait_ms;
let timer: number | undefined;
let lastMessage_ms = 0;

/** Opens the stream and keeps it open. */
export function connect(): void {
  window.clearTimeout(timer);
  source?.close();
  lastMessage_ms = Date.now();
  const opened = new EventSource(address('events:watch', { topics: kTopics }));
  source = opened;
  opened.onopen = () => {
    lastMessage_ms = Date.now();
    wait_ms = kFirstWait_ms;
    link.value = 'live';
    beginnings.value += 1;
  };
  // In state CONNECTING the browser retries from the last event id. In state CLOSED it has stopped retrying.
  opened.onerror = () => {
    link.value = 'lost';
    if (opened.readyState === EventSource.CLOSED) again();
  };
  for (const topic of kTopics) opened.addEventListener(topic, (event) => take(topic, event));
}

/** Closes the stream, for example when the user signs out. */
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
  lastMessage_ms = Date.now();
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
  if (!source || document.hidden || Date.now() - lastMessage_ms < kSilence_ms) return;
  link.value = 'lost';
  connect();
}

if (typeof window !== 'undefined') {
  window.setInterval(checkSilence, 3000);
  // When a phone wakes up or the network returns, reconnect immediately instead of waiting for the timer.
  window.addEventListener('online', () => source && connect());
  document.addEventListener('visibilitychange', () => source && link.value === 'lost' && connect());
}
