import { describe, expect, test } from 'vitest';
import { isOlder } from '../src/model/rig_order';

describe('a state of the rig', () => {
  test('is older if its revision is lower, compared as a number', () => {
    expect(isOlder({ revision: '9' }, { revision: '10' })).toBe(true);
    expect(isOlder({ revision: '10' }, { revision: '9' })).toBe(false);
    expect(isOlder({ revision: '1795600000000001' }, { revision: '1795600000000002' })).toBe(true);
  });

  test('of the same revision is not older', () => {
    expect(isOlder({ revision: '9' }, { revision: '9' })).toBe(false);
  });

  test('without a revision is older only than one with a revision', () => {
    expect(isOlder({}, { revision: '1' })).toBe(true);
    expect(isOlder({}, {})).toBe(false);
    expect(isOlder({ revision: '0' }, {})).toBe(false);
    expect(isOlder({}, undefined)).toBe(false);
  });
});
