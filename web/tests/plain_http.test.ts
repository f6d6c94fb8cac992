/** Pages that come over plain HTTP from another machine have no crypto.subtle and no crypto.randomUUID. */
import { createHash, webcrypto } from 'node:crypto';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { sha256 } from '../src/api/sha256';
import { randomId } from '../src/model/random_id';

const getRandomValues = (array: Uint8Array) => webcrypto.getRandomValues(array);

describe('over plain HTTP', () => {
  beforeEach(() => {
    vi.stubGlobal('crypto', { getRandomValues });
  });
  afterEach(() => {
    vi.unstubAllGlobals();
  });

  test.each([
    ['', 'e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855'],
    ['abc', 'ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad'],
    [
      'abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq',
      '248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1',
    ],
    ['a'.repeat(1_000_000), 'cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0'],
  ])('the hash of a FIPS 180 vector is exact (%#)', async (text, hash) => {
    expect(await sha256(new Blob([text]))).toBe(hash);
  });

  test('the hash of a file of several slices is exact', async () => {
    const bytes = Uint8Array.from({ length: (5 << 20) + 7 }, (_, i) => (i * 31) >> 3);
    const slices = vi.spyOn(Blob.prototype, 'slice');
    const hash = sha256(new Blob([bytes]));
    expect(await hash).toBe(createHash('sha256').update(bytes).digest('hex'));
    expect(slices).toHaveBeenCalledTimes(6);
    slices.mockRestore();
  });

  test('hashing ends when it is aborted or the file cannot be read', async () => {
    const controller = new AbortController();
    const hash = sha256(new Blob([new Uint8Array(4 << 20)]), controller.signal);
    controller.abort();
    await expect(hash).rejects.toThrow();
    const gone = { size: 9, slice: () => ({ arrayBuffer: () => Promise.reject(new Error()) }) };
    await expect(sha256(gone as unknown as Blob)).rejects.toThrow();
  });

  test('random ids are different UUIDs of version 4', () => {
    const ids = Array.from({ length: 1000 }, randomId);
    expect(new Set(ids).size).toBe(1000);
    for (const id of ids)
      expect(id).toMatch(/^[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$/);
  });
});

test('over TLS, the browser computes the same hash', async () => {
  vi.stubGlobal('crypto', webcrypto);
  expect(await sha256(new Blob(['abc']))).toBe(
    'ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad',
  );
  vi.unstubAllGlobals();
});
