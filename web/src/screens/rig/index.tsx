import { useEffect, useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { rig as api } from '../../api/services';
import type { Lease, Rig } from '../../api/types';
import { formatSeconds } from '../../model/units';
import { jobPath, route } from '../../route';
import {
  breakLease,
  command,
  isMoving,
  isOurs,
  refreshRig,
  releaseLease,
  rig,
  takeLease,
} from '../../state/rig';
import { may, me } from '../../state/session';
import { secondsUntil } from '../../ui/clock';
import { Button, ConfirmButton, Figures, NumberField, TextField } from '../../ui/controls';
import { FieldErrorsOf, useFieldErrors } from '../../ui/field_errors';
import { DepthPicture } from './depth_picture';
import { DipEnd, DipGuide } from './dip_guide';
import { BeginDip } from './dip_begin';
import { DriveAlarm } from './drive_alarm';
import { Gauge } from './gauge';
import { Jog } from './jog';

const kStates: Record<string, string> = {
  OFFLINE: 'Offline',
  DISARMED: 'Disarmed',
  UNHOMED: 'Not homed',
  IDLE: 'Ready',
  MOVING: 'Moving',
  DIPPING: 'Dipping',
  STOPPING: 'Stopping',
  FAULT: 'Fault',
  ESTOPPED: 'Stop button pressed',
};

export function RigScreen() {
  useEffect(() => void refreshRig(), []);
  const now = rig.value;
  if (!now) return <p class="quiet">Loading…</p>;
  return (
    <div class="rig">
      <h1>Rig</h1>
      <div class="columns with-sight">
        <div>
          <Standing now={now} />
          <Dipping dip={now.dip} />
        </div>
        <div>
          <LeasePanel now={now} />
          {isOurs.value && now.axis && <Commands now={now} />}
        </div>
        <DepthPicture />
      </div>
    </div>
  );
}

/** The running dip, the outcome of the last dip, a form to start one, or the way back to a plan. */
function Dipping({ dip }: { dip: string }) {
  const from = route.value.query.get('job');
  const [last, setLast] = useState(dip);
  useEffect(() => {
    if (dip) setLast(dip);
  }, [dip]);
  if (dip) return <DipGuide name={dip} />;
  if (last) return <DipEnd name={last} again={() => setLast('')} />;
  if (from) return <BeginDip simulateJob={`jobs/${from}`} />;
  const plan = route.value.query.get('plan');
  return plan && <BackTo plan={`jobs/${plan}`} />;
}

const BackTo = ({ plan }: { plan: string }) => (
  <p>
    <a class="button" href={jobPath(plan)}>
      Back to the plan
    </a>
  </p>
);

function Standing({ now }: { now: Rig }) {
  return (
    <section class="standing" aria-labelledby="standing-title">
      <h2 id="standing-title" class="hidden">
        State
      </h2>
      <p class={`big ${now.state.toLowerCase()}`} role="status">
        {kStates[now.state] ?? now.state}
      </p>
      {now.trouble && <p class="warning">{now.trouble}</p>}
      <DriveAlarm now={now} />
      {now.state === 'DISARMED' && (
        <p class="quiet">The drive has no torque. Arm it, then home the axis.</p>
      )}
      {now.state === 'UNHOMED' && <p class="quiet">Position unknown. Home the axis.</p>}
      {now.axis && <Gauge now={now} />}
      <Figures
        rows={[
          ['Position', now.positionMm === undefined ? '–' : `${now.positionMm.toFixed(2)} mm`],
          ['Speed', `${(now.velocityMmPerS ?? 0).toFixed(1)} mm/s`],
          now.axis !== undefined && [
            'Range',
            `${now.axis.minMm} to ${now.axis.maxMm} mm, at most ${now.axis.maxSpeedMmPerS} mm/s`,
          ],
          now.axis !== undefined && [
            'Drive',
            `${now.axis.drive}${now.axis.isVirtual ? ' (virtual)' : ''}`,
          ],
        ]}
      />
    </section>
  );
}

/** The lease: its holder, and buttons to take, release or break it. */
function LeasePanel({ now: { lease } }: { now: Rig }) {
  if (!may('OPERATOR'))
    return (
      <section>
        <h2>Control</h2>
        <p>{lease ? `${lease.holder}: ${lease.purpose}` : 'Nobody controls the rig.'}</p>
        <p class="quiet">
          You can view the rig and stop it. Other commands need the role Operator.
        </p>
      </section>
    );
  if (isOurs.value) return <OwnLease lease={lease} />;
  return lease ? <OthersLease lease={lease} /> : <FreeLease />;
}

function FreeLease() {
  const [purpose, setPurpose] = useState('');
  return (
    <section>
      <h2>Take control</h2>
      <p class="quiet">
        One person at a time can control the rig. You keep control while this page is open.
      </p>
      <TextField
        label="Purpose"
        value={purpose}
        onValue={setPurpose}
        placeholder="the mug"
        maxBytes={rules.AcquireLeaseRequest.purpose.maxBytes}
      />
      <Button kind="primary" onPress={() => takeLease(purpose.trim() || 'the web page')}>
        Take control
      </Button>
    </section>
  );
}

/** `lease` is not set until a state of the rig contains the lease. */
const OwnLease = ({ lease }: { lease: Lease | undefined }) => (
  <section>
    <h2>You control the rig</h2>
    {lease && <Purpose lease={lease} note=" (renewed automatically)" />}
    <Button onPress={releaseLease}>Release the rig</Button>
  </section>
);

function OthersLease({ lease }: { lease: Lease }) {
  const [reason, setReason] = useState('');
  return (
    <section>
      <h2>{lease.holder} controls the rig</h2>
      <Purpose lease={lease} />
      {lease.holder === me.value && (
        <p class="quiet">You hold the lease in another browser or program.</p>
      )}
      {may('ADMIN') && (
        <details>
          <summary>Break the lease of {lease.holder}</summary>
          <TextField
            label="Reason (for the audit log)"
            value={reason}
            onValue={setReason}
            maxBytes={rules.BreakLeaseRequest.reason.maxBytes}
          />
          <ConfirmButton
            sure={`Confirm: break the lease of ${lease.holder}`}
            kind="danger"
            onPress={() => breakLease(reason.trim() || 'no reason given')}
          >
            Break the lease
          </ConfirmButton>
        </details>
      )}
    </section>
  );
}

/** The purpose of the lease and its remaining time. */
function Purpose({ lease, note = '' }: { lease: Lease; note?: string }) {
  const left = secondsUntil(lease.expireTime);
  return (
    <p>
      {lease.purpose}
      {left !== undefined && (
        <span class="quiet">
          {left > 0 ? `, ${formatSeconds(left)} left` : ', just expired'}
          {note}
        </span>
      )}
    </p>
  );
}

/** The commands that the rig accepts in its current state. */
function Commands({ now }: { now: Rig }) {
  const [target, setTarget] = useState<number>();
  const errors = useFieldErrors();
  const isIdle = now.state === 'IDLE';
  const wantsReset = now.state === 'FAULT' || now.state === 'ESTOPPED';
  const axis = now.axis!;
  return (
    <section>
      <h2>Commands</h2>
      <div class="row">
        {wantsReset && (
          <Button kind="primary" onPress={() => command(api.reset)}>
            Reset
          </Button>
        )}
        {now.state === 'DISARMED' && (
          <Button kind="primary" onPress={() => command(api.arm)}>
            Arm
          </Button>
        )}
        {(now.state === 'UNHOMED' || isIdle) && (
          <Button kind={isIdle ? 'plain' : 'primary'} onPress={() => command(api.home)}>
            Home
          </Button>
        )}
        {now.enabled && !isMoving.value && (
          <ConfirmButton
            sure="Confirm disarm; the axis may sink"
            kind="plain"
            onPress={() => command(api.disarm)}
          >
            Disarm
          </ConfirmButton>
        )}
      </div>
      {/* Hidden, not removed, so that the typed number is kept while the axis moves. */}
      <div class="row" hidden={!isIdle}>
        <FieldErrorsOf value={errors}>
          <NumberField
            label="Move to"
            unit="mm"
            value={target}
            min={axis.minMm ?? 0}
            max={axis.maxMm ?? 0}
            onValue={setTarget}
            onEmpty={() => setTarget(undefined)}
          />
        </FieldErrorsOf>
        <Button
          disabled={target === undefined || errors.value.size > 0}
          onPress={() => command((id) => api.moveTo(id, target!))}
        >
          Move
        </Button>
      </div>
      {(isIdle || now.state === 'MOVING') && !now.dip && (
        <Jog fastest_mm_per_s={axis.maxSpeedMmPerS ?? 10} />
      )}
    </section>
  );
}
