/** One door to the daemon: every request goes through `call`, and what it refuses comes back as a value. */
import { signal } from '@preact/signals';
import { done, refused, type Failure, type Result } from '../model/result';

/** What a session must show on anything that changes; set when somebody signs in. */
export const csrf = signal('');

/** By how much the daemon's clock is ahead of ours, s; its Date header has whole seconds. */
export const ahead_s = signal(0);

/** Now, by the daemon's clock. */
export const daemonNow = (): Date => new Date(Date.now() + 1000 * ahead_s.value);

export type Method = 'GET' | 'HEAD' | 'POST' | 'PATCH' | 'DELETE';

export interface Options {
  /** Sent as JSON. */
  json?: unknown;
  /** Sent as it is. */
  bytes?: Blob;
  headers?: Record<string, string>;
  query?: Record<string, string | number | boolean | readonly string[] | undefined>;
  signal?: AbortSignal;
  /** Goes on even if the page is left. */
  keepalive?: boolean;
}

/** The address of a resource, as in "jobs/7" or "rig:stop". */
export function address(path: string, query: Options['query'] = {}): string {
  const parts = new URLSearchParams();
  for (const [key, value] of Object.entries(query)) {
    if (value === undefined || value === '') continue;
    for (const one of Array.isArray(value) ? value : [value]) parts.append(key, String(one));
  }
  const text = parts.toString();
  // Names from strangers may hold anything; ":" and "/" are the API's own.
  const plain = path.split('/').map(encodeURIComponent).join('/').replaceAll('%3A', ':');
  return `/v1/${plain}${text ? `?${text}` : ''}`;
}

/** Asks the daemon; T is what it then answers. */
export async function call<T>(
  method: Method,
  path: string,
  options: Options = {},
): Promise<Result<T>> {
  const answer = await send(method, path, options);
  if (!answer.ok) return answer;
  const { value: response } = answer;
  if (response.ok) {
    if (method === 'HEAD' || response.status === 204) return done({} as T);
    const text = await response.text().catch(() => undefined);
    if (text === undefined) return lost();
    try {
      return done((text === '' ? {} : JSON.parse(text)) as T);
    } catch {
      return refused('the daemon answered what nobody understands', 'Reload the page', {
        status: 0,
      });
    }
  }
  return { ok: false, failure: await failureOf(response) };
}

/** The same for bytes. */
export async function fetchBytes(path: string, signal?: AbortSignal): Promise<Result<ArrayBuffer>> {
  const answer = await send('GET', path, signal ? { signal } : {});
  if (!answer.ok) return answer;
  if (!answer.value.ok) return { ok: false, failure: await failureOf(answer.value) };
  const bytes = await answer.value.arrayBuffer().catch(() => undefined);
  return bytes ? done(bytes) : lost();
}

async function send(method: Method, path: string, options: Options): Promise<Result<Response>> {
  const headers: Record<string, string> = { Accept: 'application/json', ...options.headers };
  if (options.json !== undefined) headers['Content-Type'] = 'application/json';
  if (method !== 'GET' && method !== 'HEAD' && csrf.value)
    headers['X-Hydroprint-Csrf'] = csrf.value;
  const body = options.bytes ?? (options.json === undefined ? null : JSON.stringify(options.json));
  try {
    const response = await fetch(address(path, options.query), {
      method,
      headers,
      body,
      credentials: 'same-origin',
      cache: 'no-store',
      signal: options.signal ?? null,
      keepalive: options.keepalive ?? false,
    });
    readClock(response);
    return done(response);
  } catch {
    if (options.signal?.aborted) return refused('given up', undefined, { reason: 'ABORTED_HERE' });
    return lost();
  }
}

const lost = () =>
  refused('the daemon does not answer', 'Check the network; the page tries again by itself', {
    status: 0,
  });

function readClock(response: Response): void {
  const date = Date.parse(response.headers.get('Date') ?? '');
  if (Number.isNaN(date)) return;
  const ahead = (date - Date.now()) / 1000;
  // Below what whole seconds and the way here make of it, the clocks agree.
  ahead_s.value =
    Math.abs(ahead) < 2 ? 0 : Math.abs(ahead - ahead_s.value) < 2 ? ahead_s.value : ahead;
}

interface Status {
  error?: {
    message?: string;
    status?: string;
    details?: { '@type'?: string; reason?: string; metadata?: Record<string, string> }[];
  };
}

async function failureOf(response: Response): Promise<Failure> {
  const status = response.status;
  const body = (await response.json().catch(() => ({}))) as Status;
  const info = body.error?.details?.find((detail) => detail.reason);
  return {
    what: body.error?.message || `the daemon refused this (HTTP ${status})`,
    status,
    reason: info?.reason ?? body.error?.status ?? '',
    ...remedyOf(status),
    ...(info?.metadata ? { metadata: info.metadata } : {}),
  };
}

// The daemon's own line has the remedy, but for what only the page knows.
function remedyOf(status: number): { remedy?: string } {
  if (status === 401) return { remedy: 'Sign in' };
  if (status === 503) return { remedy: 'The daemon is starting or ending: try again in a moment' };
  return {};
}
