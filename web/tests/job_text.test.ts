import { expect, test } from 'vitest';
import type { Queue } from '../src/api/types';
import { clusterReason, holdReason } from '../src/ui/job_text';

test('a job that waits in the queue of a cluster has its reason', () => {
  expect(clusterReason({ state: 'RUNNING', phase: 'waiting: Resources' })).toBe('Resources');
  expect(clusterReason({ state: 'RUNNING', phase: 'velocity' })).toBeUndefined();
  expect(clusterReason({ state: 'CANCELLING', phase: 'waiting: Resources' })).toBeUndefined();
  expect(clusterReason({ state: 'RUNNING', phase: '' })).toBeUndefined();
});

test('a job that waits shows why no job starts', () => {
  const queue = { paused: false, pauseReason: '', blockedReason: '' } as Queue;
  expect(holdReason(undefined)).toBeUndefined();
  expect(holdReason(queue)).toBeUndefined();
  expect(holdReason({ ...queue, blockedReason: 'the share is full' })).toBe('the share is full');
  expect(holdReason({ ...queue, paused: true })).toBe('the queue is paused');
  expect(holdReason({ ...queue, paused: true, pauseReason: 'new film' })).toBe(
    'the queue is paused: new film',
  );
});
