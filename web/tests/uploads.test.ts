/** Uploads to a small daemon behind a proxy with nginx's default limit. */
import { createHash, webcrypto } from 'node:crypto';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { address, call } from '../src/api/call';
import { upload } from '../src/api/uploads';

const kLimit = 1 << 20;
const bytes = Uint8Array.from({ length: 3_000_001 }, (_, i) => (i * 7) % 251);
const hash = createHash('sha256').update(bytes).digest('hex');

let received: Buffer;
let requests: string[];
/** Answers the request instead of the daemon, once. */
let instead: (() => Response) | undefined;

async function daemon(url: string, { method, body, headers }: RequestInit): Promise<Response> {
  requests.push(`${method} ${url}`);
  const other = instead?.();
  instead = undefined;
  if (other) return other;
  const state = () => ({ name: 'uploads/3', receivedBytes: String(received.length) });
  if (method === 'POST') return Response.json({ upload: state() });
  if (method === 'GET') return Response.json(state());
  const chunk = Buffer.from(await (body as Blob).arrayBuffer());
  if (chunk.length > kLimit) return new Response('<html>413</html>', { status: 413 });
  expect((headers as Record<string, string>)['Upload-Offset']).toBe(String(received.length));
  received = Buffer.concat([received, chunk]);
  if (received.length < bytes.length) return new Response(null, { status: 204 });
  return Response.json({ name: `assets/${createHash('sha256').update(received).digest('hex')}` });
}

const send = () => upload(new Blob([bytes]), () => {}, new AbortController().signal);

describe('uploads', () => {
  beforeEach(() => {
    received = Buffer.alloc(0);
    requests = [];
    instead = undefined;
    const kept = new Map<string, string>();
    vi.stubGlobal('crypto', webcrypto);
    vi.stubGlobal('fetch', daemon);
    vi.stubGlobal('localStorage', {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => kept.set(key, value),
      removeItem: (key: string) => kept.delete(key),
    });
  });
  afterEach(() => {
    vi.unstubAllGlobals();
  });

  test('arrive whole through a proxy that allows 1 MiB, in one request per chunk', async () => {
    expect(await send()).toEqual({ ok: true, value: `assets/${hash}` });
    expect(requests).toEqual([
      'POST v1/uploads',
      ...Array.from({ length: 6 }, () => 'PATCH v1/uploads/3'),
    ]);
  });

  test('continue where the daemon is after a proxy reported that it was away', async () => {
    let count = 0;
    vi.stubGlobal('fetch', (url: string, init: RequestInit) => {
      count += 1;
      if (count === 3) instead = () => new Response('<html>502</html>', { status: 502 });
      return daemon(url, init);
    });
    expect(await send()).toEqual({ ok: true, value: `assets/${hash}` });
    expect(requests.slice(1, 5)).toEqual([
      'PATCH v1/uploads/3',
      'PATCH v1/uploads/3',
      'GET v1/uploads/3',
      'PATCH v1/uploads/3',
    ]);
  });

  test('that a proxy still refuses as too large end with the name of its setting', async () => {
    instead = () => new Response('<html>413</html>', { status: 413 });
    const result = await send();
    expect(result.ok).toBe(false);
    if (!result.ok) {
      expect(result.failure.what).toContain('reverse proxy');
      expect(result.failure.remedy).toContain('client_max_body_size');
    }
  });
});

test('URLs are relative to the page, which a proxy may serve in a folder', async () => {
  const at = (path: string) => new URL(path, 'https://print.lan/hydroprint/#/jobs/7').href;
  expect(at(address('rig:stop'))).toBe('https://print.lan/hydroprint/v1/rig:stop');
  expect(at(address('jobs/7/artifacts/a b.png:download', { inline: 1 }))).toBe(
    'https://print.lan/hydroprint/v1/jobs/7/artifacts/a%20b.png:download?inline=1',
  );
});

test('errors of the daemon are shown as it words them, also with status 413 and 503', async () => {
  for (const status of [413, 503]) {
    vi.stubGlobal('fetch', () =>
      Promise.resolve(Response.json({ error: { message: 'own words' } }, { status })),
    );
    const result = await call('GET', 'queue');
    expect(!result.ok && result.failure.what).toBe('own words');
    expect(!result.ok && result.failure.status).toBe(status);
  }
  vi.unstubAllGlobals();
});
