import { expect, test } from 'vitest';
import { clusterReason } from '../src/ui/job_text';

test('a job that waits in the queue of a cluster has its reason', () => {
  expect(clusterReason({ state: 'RUNNING', phase: 'waiting: Resources' })).toBe('Resources');
  expect(clusterReason({ state: 'RUNNING', phase: 'velocity' })).toBeUndefined();
  expect(clusterReason({ state: 'CANCELLING', phase: 'waiting: Resources' })).toBeUndefined();
  expect(clusterReason({ state: 'RUNNING', phase: '' })).toBeUndefined();
});
