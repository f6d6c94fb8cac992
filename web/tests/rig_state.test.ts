import { beforeEach, describe, expect, test, vi } from 'vitest';
import type { Lease, Rig, WhoAmI } from '../src/api/types';
import { done, refused } from '../src/model/result';

const lease = vi.hoisted(() => ({ acquire: vi.fn(), renew: vi.fn(), release: vi.fn() }));
const rigApi = vi.hoisted(() => ({ get: vi.fn(), arm: vi.fn() }));
vi.mock('../src/api/services', () => ({ lease, rig: rigApi, session: {} }));

const kept = new Map<string, string>();
vi.stubGlobal('localStorage', {
  getItem: (key: string) => kept.get(key) ?? null,
  setItem: (key: string, value: string) => kept.set(key, value),
  removeItem: (key: string) => kept.delete(key),
});
vi.stubGlobal('document', { addEventListener: () => {} });
vi.stubGlobal('window', {
  addEventListener: () => {},
  setInterval: () => 0,
  setTimeout: () => 0,
});

const kOurs = { leaseId: 'f00d', acquireTime: '2026-11-25T12:00:00.120Z' } as Lease;
const kOther = { leaseId: '', acquireTime: '2026-11-25T12:34:56Z', holder: 'max' } as Lease;
const kLost = refused('lease required', undefined, { status: 400, reason: 'LEASE_REQUIRED' });

const stateOf = (revision: number | undefined, held?: Lease): Rig =>
  ({
    state: 'IDLE',
    ...(revision === undefined ? {} : { revision: String(revision) }),
    ...(held ? { lease: { ...held, leaseId: '' } } : {}),
  }) as Rig;

/** Loads the page's state as an operator; `id` is the lease's id that the browser has stored. */
async function load(id = '') {
  kept.clear();
  if (id) kept.set('lease', id);
  vi.resetModules();
  const { who } = await import('../src/state/session');
  who.value = { role: 'OPERATOR', user: 'otto' } as WhoAmI;
  return import('../src/state/rig');
}
const settle = () => new Promise((resolve) => setTimeout(resolve));

beforeEach(() => {
  vi.resetAllMocks();
  lease.acquire.mockResolvedValue(done(kOurs));
  lease.renew.mockResolvedValue(done(kOurs));
  lease.release.mockResolvedValue(done({}));
  rigApi.get.mockResolvedValue(done(stateOf(10, kOurs)));
});

describe('the shown state of the rig', () => {
  test('is never replaced by an older one', async () => {
    const { rig, show } = await load();
    show(stateOf(10));
    show(stateOf(9, kOther));
    expect(rig.value).toEqual(stateOf(10));
    show(stateOf(10, kOther));
    expect(rig.value).toEqual(stateOf(10, kOther));
  });

  test('is the last one if the daemon does not number its states', async () => {
    const { rig, show } = await load();
    show(stateOf(undefined, kOther));
    show(stateOf(undefined));
    expect(rig.value).toEqual(stateOf(undefined));
  });
});

describe('the lease', () => {
  test('is ours once the daemon has granted it, before a state contains it', async () => {
    const { isOurs, takeLease } = await load();
    rigApi.get.mockResolvedValue(done(stateOf(5)));
    await takeLease('the mug');
    expect(isOurs.value).toBe(true);
    await settle();
    expect(isOurs.value).toBe(true);
  });

  test.each([11, undefined])('stays ours if state %s from before it arrives', async (revision) => {
    const { isOurs, rig, show, takeLease } = await load();
    if (revision === undefined) rigApi.get.mockResolvedValue(done(stateOf(undefined, kOurs)));
    await takeLease('the mug');
    show(stateOf(revision));
    expect(rig.value?.lease).toBeUndefined();
    expect(isOurs.value).toBe(true);
    await settle();
    expect(isOurs.value).toBe(true);
  });

  test('is lost if a newer state lacks it and the daemon refuses to renew it', async () => {
    const { isOurs, show, takeLease } = await load();
    await takeLease('the mug');
    expect(lease.renew).not.toHaveBeenCalled();
    lease.renew.mockResolvedValue(kLost);
    show(stateOf(11, kOther));
    await settle();
    expect(isOurs.value).toBe(false);
    expect(kept.has('lease')).toBe(false);
  });

  test('is not lost if the daemon does not answer', async () => {
    const { isOurs, show, takeLease } = await load();
    await takeLease('the mug');
    lease.renew.mockResolvedValue(refused('no answer', undefined, { status: 0 }));
    show(stateOf(11));
    await settle();
    expect(isOurs.value).toBe(true);
  });

  test('is lost if a command is refused for lack of it', async () => {
    const { command, isOurs, takeLease } = await load();
    await takeLease('the mug');
    rigApi.arm.mockResolvedValue(kLost);
    expect(await command((id) => rigApi.arm(id))).toBe(false);
    expect(isOurs.value).toBe(false);
  });

  test('is kept across a reload if it still holds, and renewed once', async () => {
    const { isOurs, show } = await load('f00d');
    expect(isOurs.value).toBe(true);
    show(stateOf(10, kOurs));
    await settle();
    show(stateOf(11, kOurs));
    await settle();
    expect(lease.renew).toHaveBeenCalledTimes(1);
    expect(isOurs.value).toBe(true);
  });

  test('is lost after a reload if it ended meanwhile', async () => {
    const { isOurs, show } = await load('f00d');
    lease.renew.mockResolvedValue(kLost);
    show(stateOf(10));
    await settle();
    expect(isOurs.value).toBe(false);
  });

  test('that is being released is not reported as lost', async () => {
    const { isOurs, releaseLease, show, takeLease } = await load();
    const { notices } = await import('../src/state/notices');
    await takeLease('the mug');
    lease.renew.mockResolvedValue(kLost);
    lease.release.mockImplementation(async () => {
      show(stateOf(11));
      return done({});
    });
    rigApi.get.mockResolvedValue(done(stateOf(12)));
    await releaseLease();
    await settle();
    expect(isOurs.value).toBe(false);
    expect(notices.value.map(({ kind }) => kind)).toEqual(['done']);
  });
});
