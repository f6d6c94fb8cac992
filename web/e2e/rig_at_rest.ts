import { expect } from 'vitest';
import { asAdmin } from './accounts';
import type { Daemon } from './daemon';

interface RigState {
  state: string;
  enabled: boolean;
  dip: string;
}

const kPatience = { timeout: 30_000 };
const kUnsettled = ['OFFLINE', 'MOVING', 'DIPPING', 'STOPPING'];

/** Brings the rig to rest: disarmed, without fault, dip or lease, whatever the test before it did. */
export async function restRig(daemon: Daemon): Promise<void> {
  const send = await asAdmin(daemon.address);
  const stateOf = () => send<RigState>('GET', 'rig');
  await daemon.act('clear');
  await send('POST', 'rig:stop');
  const { dip } = await stateOf();
  if (dip) await send('POST', `${dip}:cancel`);
  await expect
    .poll(async () => {
      const { state, dip: unfinished } = await stateOf();
      return kUnsettled.includes(state) || unfinished !== '';
    }, kPatience)
    .toBe(false);
  await send('POST', 'rig/lease:break', { reason: 'the next test' });

  const { state, enabled } = await stateOf();
  const isAtFault = ['FAULT', 'ESTOPPED'].includes(state);
  if (!isAtFault && !enabled) return;
  const { leaseId } = await send<{ leaseId: string }>('POST', 'rig/lease:acquire', {
    purpose: 'the next test',
    ttl: '60s',
  });
  await send('POST', isAtFault ? 'rig:resetFault' : 'rig:disarm', { leaseId });
  await expect.poll(async () => (await stateOf()).state, kPatience).toBe('DISARMED');
  await send('POST', 'rig/lease:release', { leaseId });
}
