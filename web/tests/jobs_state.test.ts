import { expect, test, vi } from 'vitest';
import type { Job, JobEvent } from '../src/api/types';
import { known, remember } from '../src/state/jobs';

type Listener = (data: unknown) => void;
const listeners = vi.hoisted(() => new Map<string, Listener>());
vi.mock('../src/events', async () => ({
  beginnings: (await import('@preact/signals')).signal(0),
  on: (topic: string, listener: Listener) => listeners.set(topic, listener),
}));

test('events tell what a job waits for, and that it does not wait any more', () => {
  const name = 'jobs/7';
  const happens = (event: Partial<JobEvent>) => {
    listeners.get('job')!({ event: { job: name, kind: 'PROGRESS', ...event } });
    const { state, waitsFor } = known.value.get(name)!;
    return [state, waitsFor];
  };
  remember({ name, state: 'RUNNING', waitsFor: '' } as Job);
  expect(happens({ waitsFor: 'Resources' })).toEqual(['RUNNING', 'Resources']);
  expect(happens({ progressFraction: 0 })).toEqual(['RUNNING', 'Resources']);
  expect(happens({ state: 'CANCELLING', waitsFor: '' })).toEqual(['CANCELLING', '']);
});
