import { h, render, type VNode } from 'preact';
import { expect, test, vi } from 'vitest';
import type { Job, Queue } from '../src/api/types';
import { holdReason, JobProgress, State } from '../src/ui/job_text';
import { TinyNode, tinyDocument } from './tiny_dom';

vi.stubGlobal('document', tinyDocument);

function textOf(shown: VNode): string {
  const page = new TinyNode(1, 'main');
  render(shown, page as unknown as Element);
  return page.text;
}

test('a running job that waits is shown as waiting, with its reason', () => {
  const job = { name: 'jobs/7', state: 'RUNNING', progressFraction: 0.5 } as Job;
  const shown = (waitsFor: string) =>
    textOf(
      h(
        'p',
        {},
        h(State, { state: job.state, waitsFor }),
        h(JobProgress, { job: { ...job, waitsFor } }),
      ),
    );
  expect(shown('Resources')).toBe('waitingwaiting: Resources');
  expect(shown('')).toBe('running50 %');
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
