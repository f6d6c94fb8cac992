/** The last known state of the rig, and this page's lease. */
import { computed, effect, signal } from '@preact/signals';
import { daemonNow } from '../api/call';
import { lease as leaseApi, rig as api } from '../api/services';
import type { Lease, Rig } from '../api/types';
import { beginnings, on } from '../events';
import { isOlder } from '../model/rig_order';
import { complain, say } from './notices';
import { may } from './session';

/** Changed only by `show`. */
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

/**
 * True if this page holds the lease, as far as it knows. A state without the lease does not end it, because the state may
 * be from before the lease was taken; `show` then asks the daemon.
 */
export const isOurs = computed(() => leaseId.value !== '' && may('OPERATOR'));

// Identifies our lease in the rig's states, which do not contain its id. Unknown after a reload, until it is renewed.
let acquireTime: string | undefined;

function keep(lease?: Lease): void {
  acquireTime = lease?.acquireTime;
  leaseId.value = lease?.leaseId ?? '';
  if (leaseId.value) localStorage.setItem(kKey, leaseId.value);
  else localStorage.removeItem(kKey);
}

/** Shows a state of the rig unless a newer one is shown already. All states go through this function. */
export function show(state: Rig): void {
  if (isOlder(state, rig.value)) return;
  rig.value = state;
  if (!state.lease || state.lease.acquireTime !== acquireTime) void renew();
}

on('rig', (data) => show(data as Rig));

export async function refreshRig(): Promise<void> {
  const answer = await api.get();
  if (answer.ok) show(answer.value);
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
      show(answer.value);
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
  keep(answer.value);
  await refreshRig();
  return true;
}

export async function releaseLease(): Promise<void> {
  isReleasing = true;
  const answer = await leaseApi.release(leaseId.value);
  isReleasing = false;
  if (!answer.ok) return complain(answer.failure);
  keep();
  await refreshRig();
  say('The rig was released');
}

export async function breakLease(reason: string): Promise<void> {
  const answer = await leaseApi.break(reason);
  if (!answer.ok) return complain(answer.failure);
  await refreshRig();
}

let isRenewing = false;
let isReleasing = false;

/** Renews the lease, and reports its loss if the daemon refuses. */
async function renew(): Promise<void> {
  if (!isOurs.value || isRenewing || isReleasing) return;
  const id = leaseId.value;
  isRenewing = true;
  const answer = await leaseApi.renew(id, kLease_s);
  isRenewing = false;
  if (leaseId.value !== id || isReleasing) return;
  if (answer.ok) return keep(answer.value);
  const { status = 0 } = answer.failure;
  // Without a connection or a session, the daemon has not decided about the lease.
  if (status < 400 || status === 401 || status >= 500) return;
  keep();
  complain({ what: 'Your lease of the rig has ended', remedy: 'Take control of the rig again' });
}

/** Renews the lease in time while the page is open. */
function renewInTime(): void {
  const expire_ms = Date.parse(rig.value?.lease?.expireTime ?? '');
  if (expire_ms - daemonNow().getTime() <= (1000 * kLease_s) / 2) void renew();
}

window.setInterval(renewInTime, 20_000);

/** Sends a command to the rig, shows a failure as a notice, and detects a lost lease. Returns true on success. */
export async function command(
  work: (leaseId: string) => ReturnType<typeof api.arm>,
): Promise<boolean> {
  const answer = await work(leaseId.value);
  if (answer.ok) {
    show(answer.value);
    return true;
  }
  if (answer.failure.reason === 'LEASE_REQUIRED') keep();
  complain(answer.failure);
  return false;
}
