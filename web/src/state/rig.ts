/** The last known state of the rig, and this page's lease. */
import { computed, effect, signal } from '@preact/signals';
import { daemonNow } from '../api/call';
import { lease as leaseApi, rig as api } from '../api/services';
import type { Rig } from '../api/types';
import { beginnings, on } from '../events';
import { complain, say } from './notices';

export const rig = signal<Rig | undefined>(undefined);

/** Result of the last stop request. */
export const stopState = signal<'ready' | 'sending' | 'stopped' | 'failed'>('ready');

export const isMoving = computed(() =>
  ['MOVING', 'DIPPING', 'STOPPING'].includes(rig.value?.state ?? ''),
);

// Kept across reloads. The daemon owns the lease; the page stores only its id.
const kKey = 'lease';
export const leaseId = signal(localStorage.getItem(kKey) ?? '');
export const kLease_s = 600;

/** True if this page holds the lease. */
export const isOurs = computed(() => leaseId.value !== '' && rig.value?.lease != null);

function keep(id: string): void {
  leaseId.value = id;
  if (id) localStorage.setItem(kKey, id);
  else localStorage.removeItem(kKey);
}

on('rig', (data) => {
  rig.value = data as Rig;
});

export async function refreshRig(): Promise<void> {
  const answer = await api.get();
  if (answer.ok) rig.value = answer.value;
}

effect(() => {
  if (beginnings.value > 0) void refreshRig();
});

const kTries = 5;

/** Stops any motion. Retries immediately if the request fails. */
export async function stop(): Promise<void> {
  stopState.value = 'sending';
  for (let i = 0; i < kTries; i += 1) {
    const answer = await api.stop();
    if (answer.ok) {
      rig.value = answer.value;
      stopState.value = 'stopped';
      window.setTimeout(() => (stopState.value = 'ready'), 3000);
      return;
    }
    if (answer.failure.status !== 0) complain(answer.failure);
  }
  stopState.value = 'failed';
  complain({
    what: 'The stop request failed',
    remedy: 'Press the stop button on the rig itself',
  });
}

export async function takeLease(purpose: string): Promise<boolean> {
  const answer = await leaseApi.acquire(purpose, kLease_s);
  if (!answer.ok) {
    complain(answer.failure);
    return false;
  }
  keep(answer.value.leaseId ?? '');
  await refreshRig();
  return true;
}

export async function releaseLease(): Promise<void> {
  const answer = await leaseApi.release(leaseId.value);
  if (!answer.ok) return complain(answer.failure);
  keep('');
  await refreshRig();
  say('The rig was released');
}

export async function breakLease(reason: string): Promise<void> {
  const answer = await leaseApi.break(reason);
  if (!answer.ok) return complain(answer.failure);
  await refreshRig();
}

/** Renews the lease while the page is open and reports its loss. */
async function renew(): Promise<void> {
  const lease = rig.value?.lease;
  if (!leaseId.value || !lease) return;
  const left_s = (Date.parse(lease.expireTime ?? '') - daemonNow().getTime()) / 1000;
  if (left_s > kLease_s / 2) return;
  const answer = await leaseApi.renew(leaseId.value, kLease_s);
  if (answer.ok || answer.failure.status === 0) return;
  keep('');
  complain({ what: 'Your lease of the rig has ended', remedy: 'Take control of the rig again' });
}

window.setInterval(() => void renew(), 20_000);

/** Sends a command to the rig, shows a failure as a notice, and detects a lost lease. Returns true on success. */
export async function command(
  work: (leaseId: string) => ReturnType<typeof api.arm>,
): Promise<boolean> {
  const answer = await work(leaseId.value);
  if (answer.ok) {
    rig.value = answer.value;
    return true;
  }
  if (answer.failure.reason === 'LEASE_REQUIRED') keep('');
  complain(answer.failure);
  return false;
}
