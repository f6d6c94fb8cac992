/** Sends requests to the daemon. Every request goes through this file, and errors are returned as values. */
import { signal } from '@preact/signals';
import { withLabel } from '../model/fields';
import { done, refused, type Failure, type Result, type Violation } from '../model/result';

/** The session's CSRF token, sent with every request that changes something; set at sign-in. */
export const csrf = signal('');

/** Time by which the daemon's clock is ahead of the browser's, s; inexact: the Date header has whole seconds. */
export const ahead_s = signal(0);

/** The current time by the daemon's clock. */
export const daemonNow = (): Date => new Date(Date.now() + 1000 * ahead_s.value);

export type Method = 'GET' | 'HEAD' | 'POST' | 'PATCH' | 'DELETE';

export interface Options {
  /** Sent as JSON. */
  json?: unknown;
  /** Sent unchanged. */
  bytes?: Blob;
  headers?: Record<string, string>;
  query?: Record<string, string | number | boolean | readonly string[] | undefined>;
  signal?: AbortSignal;
  /** The request is completed even if the page is closed. */
  keepalive?: boolean;
}

/**
 * The URL of a resource, such as "jobs/7" or "rig:stop". It is relative to the page, which a reverse proxy may serve in a
 * folder.
 */
export function address(path: string, query: Options['query'] = {}): string {
  const parts = new URLSearchParams();
  for (const [key, value] of Object.entries(query)) {
    if (value === undefined || value === '') continue;
    for (const one of Array.isArray(value) ? value : [value]) parts.append(key, String(one));
  }
  const text = parts.toString();
  // Names are untrusted and may contain any character, so all are encoded except ":" and "/", which the API uses.
  const plain = path.split('/').map(encodeURIComponent).join('/').replaceAll('%3A', ':');
  return `v1/${plain}${text ? `?${text}` : ''}`;
}

/** Sends a request to the daemon; T is the type of its response. */
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
    if (text === undefined) return unanswered(options);
    try {
      return done((text === '' ? {} : JSON.parse(text)) as T);
    } catch {
      return refused("the daemon's response cannot be read", 'Reload the page', {
        status: 0,
      });
    }
  }
  return { ok: false, failure: await failureOf(response) };
}

/** Gets bytes, such as an artifact, from the daemon. */
export async function fetchBytes(
  path: string,
  { method = 'GET', ...options }: Options & { method?: Method } = {},
): Promise<Result<ArrayBuffer>> {
  const answer = await send(method, path, options);
  if (!answer.ok) return answer;
  if (!answer.value.ok) return { ok: false, failure: await failureOf(answer.value) };
  const bytes = await answer.value.arrayBuffer().catch(() => undefined);
  return bytes ? done(bytes) : unanswered(options);
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
    return unanswered(options);
  }
}

const unanswered = ({ signal }: Options) =>
  signal?.aborted ? refused('cancelled', undefined, { reason: 'ABORTED_HERE' }) : lost();

const lost = () =>
  refused(
    'the daemon does not answer',
    'Check the network, then try again. The page reconnects automatically',
    { status: 0 },
  );

function readClock(response: Response): void {
  const date = Date.parse(response.headers.get('Date') ?? '');
  if (Number.isNaN(date)) return;
  const ahead = (date - Date.now()) / 1000;
  // Smaller differences come from the whole seconds of the header and from network latency.
  ahead_s.value =
    Math.abs(ahead) < 2 ? 0 : Math.abs(ahead - ahead_s.value) < 2 ? ahead_s.value : ahead;
}

interface Status {
  error?: {
    message?: string;
    status?: string;
    details?: { '@type'?: string; reason?: string; fieldViolations?: Violation[] }[];
  };
}

async function failureOf(response: Response): Promise<Failure> {
  const status = response.status;
  const body = (await response.json().catch(() => undefined)) as Status | undefined;
  if (!body?.error) return failureOfProxy(status);
  const { message, details = [] } = body.error;
  const violations = details.flatMap(({ fieldViolations = [] }) => fieldViolations);
  // The daemon's message has the paths of the fields instead of their labels.
  const labelled = violations.map(({ field, description }) => withLabel(field, description));
  return {
    what: labelled.join('; ') || message || `the daemon refused the request (HTTP ${status})`,
    status,
    reason: details.find(({ reason }) => reason)?.reason ?? body.error.status ?? '',
    ...remedyOf(status),
    violations,
  };
}

// The daemon describes every error in JSON. Other responses come from a proxy before the daemon.
function failureOfProxy(status: number): Failure {
  if ([502, 503, 504].includes(status)) return lost().failure;
  if (status === 413)
    return {
      what: 'a reverse proxy refused the request because it is too large (HTTP 413)',
      remedy:
        'Ask an admin to raise the proxy’s limit to 1 MiB or more (nginx: client_max_body_size 1m)',
      status,
    };
  return {
    what: `the request was refused (HTTP ${status}), and not by the daemon`,
    remedy: 'Ask an admin to check the reverse proxy',
    status,
  };
}

// Most messages of the daemon contain the remedy. For these statuses, the page adds it.
function remedyOf(status: number): { remedy?: string } {
  if (status === 401) return { remedy: 'Reload the page, then sign in' };
  if (status === 503) return { remedy: 'If the error remains, ask an admin to check the daemon' };
  return {};
}
