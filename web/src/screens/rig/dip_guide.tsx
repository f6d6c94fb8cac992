import { useEffect } from 'preact/hooks';
import { imageAddress, jobs as api } from '../../api/services';
import type { Job } from '../../api/types';
import { withLabel } from '../../model/fields';
import { formatSeconds } from '../../model/units';
import { jobPath } from '../../route';
import { known, refresh, remember } from '../../state/jobs';
import { orNotify } from '../../state/notices';
import { isOurs, leaseId, rig } from '../../state/rig';
import { secondsUntil } from '../../ui/clock';
import { Button, ConfirmButton } from '../../ui/controls';
import { dipText, State } from '../../ui/job_text';
import { WarningLines } from '../../ui/warning';
import { Jog } from './jog';

/**
 * The steps of a dip in order; `confirm` is the button text of steps that wait for the operator, and
 * `measured` the one where first contact is known from a calibration.
 */
const kSteps: { step: string; title: string; confirm?: string; measured?: string }[] = [
  { step: 'PRINT_FILM', title: 'Print the film', confirm: 'The film is printed' },
  { step: 'LOAD_OBJECT', title: 'Mount the object', confirm: 'The object is mounted' },
  {
    step: 'FIND_CONTACT',
    title: 'Find first contact',
    confirm: 'The object almost touches the water',
    measured: 'First contact is measured, hands are clear: go on',
  },
  { step: 'CLEAR', title: 'Raise the object' },
  { step: 'LAY_FILM', title: 'Lay the film', confirm: 'The film floats between the bars' },
  { step: 'SOAK', title: 'Soak' },
  { step: 'SPRAY_ACTIVATOR', title: 'Spray the activator', confirm: 'The activator is sprayed' },
  { step: 'ACTIVATE', title: 'Wait for the activator' },
  { step: 'START_DIP', title: 'Start the dip', confirm: 'Hands are clear: dip now' },
  { step: 'DESCEND', title: 'Lower the object' },
  { step: 'HOLD', title: 'Hold' },
  { step: 'RETRACT', title: 'Raise the object again' },
];

/** The steps in which the object is hung in its pose. */
const kHanging: readonly string[] = ['PRINT_FILM', 'LOAD_OBJECT', 'FIND_CONTACT'];

const titleOf = ({ immersion, immersions }: NonNullable<Job['dipStatus']>): string =>
  immersion ? dipText(immersion, immersions) : 'Dip';

/** The running dip: instruction, remaining time, and one large button. */
export function DipGuide({ name }: { name: string }) {
  useEffect(() => void refresh(name), [name]);
  const job = known.value.get(name);
  if (!job?.dipStatus) return <p class="quiet">Loading the dip…</p>;
  const { dipStatus: status } = job;
  const at = kSteps.findIndex(({ step }) => step === status.step);
  const here = kSteps[at];
  const isMeasured = status.contactMm !== undefined;
  const left = secondsUntil(status.stepEndTime);
  const film = secondsUntil(status.activationEndTime);
  return (
    <section class="dip" aria-labelledby="dip-title">
      <h2 id="dip-title">
        {titleOf(status)}, step {at + 1} of {kSteps.length}: {here?.title}
      </h2>
      <p class="instruction" role="status">
        {status.instruction}
      </p>
      {status.picture && kHanging.includes(status.step) && (
        <img class="planned-pose" src={imageAddress(status.picture)} alt="The planned pose" />
      )}
      {left !== undefined && (
        <p class="clock" role="timer">
          {formatSeconds(Math.max(0, Math.ceil(left)))}
          <span class="quiet"> left in this step</span>
        </p>
      )}
      {film !== undefined && (
        <p class={film > 0 ? '' : 'warning'} role="timer">
          {film > 0
            ? `The film can be used for ${formatSeconds(Math.ceil(film))}`
            : `The film became too old ${formatSeconds(-Math.floor(film))} ago; the print may be poor`}
        </p>
      )}
      <WarningLines warnings={status.warnings} />
      {status.step === 'FIND_CONTACT' && isOurs.value && (
        <Jog fastest_mm_per_s={rig.value?.axis?.maxSpeedMmPerS ?? 10} />
      )}
      <Confirm job={job} words={(isMeasured && here?.measured) || here?.confirm} />
      <Steps at={at} />
      <p class="row">
        <a href={jobPath(name)}>Dip record</a>
        {isOurs.value && (
          <ConfirmButton
            sure="Confirm abort; the film will be lost"
            kind="plain"
            onPress={() => abort(name)}
          >
            Abort the dip
          </ConfirmButton>
        )}
      </p>
    </section>
  );
}

/** Shown after a dip: its outcome and the next instruction. */
export function DipEnd({ name, again }: { name: string; again: () => void }) {
  useEffect(() => void refresh(name), [name]);
  const job = known.value.get(name);
  return (
    <section class="dip" aria-labelledby="end-title">
      <h2 id="end-title">The dip has ended: {job ? <State state={job.state} /> : '…'}</h2>
      {job?.dipStatus?.instruction && <p class="instruction">{job.dipStatus.instruction}</p>}
      {job?.error && <p class="warning">{withLabel(job.error.field, job.error.message)}</p>}
      <p class="row">
        {job?.dipStatus?.planJob && (
          <a class="button primary" href={jobPath(job.dipStatus.planJob)}>
            Back to the plan
          </a>
        )}
        <a class="button" href={jobPath(name)}>
          Dip record
        </a>
        <button type="button" class="plain" onClick={again}>
          Close
        </button>
      </p>
    </section>
  );
}

async function abort(name: string): Promise<void> {
  const job = orNotify(await api.cancel(name));
  if (job) remember(job);
}

function Confirm({ job, words }: { job: Job; words: string | undefined }) {
  if (!words || job.state !== 'WAITING_FOR_OPERATOR') return null;
  if (!isOurs.value)
    return (
      <p class="quiet">
        Only the person who controls the rig can confirm this step. To confirm it, take control of
        the rig.
      </p>
    );
  return (
    <Button
      kind="primary"
      onPress={async () => {
        const step = job.dipStatus?.step ?? '';
        const next = orNotify(await api.confirm(job.name, step, leaseId.value));
        if (next) remember(next);
      }}
    >
      {words}
    </Button>
  );
}

const Steps = ({ at }: { at: number }) => (
  <ol class="steps">
    {kSteps.map(({ step, title }, i) => (
      <li
        key={step}
        class={i < at ? 'past' : i === at ? 'here' : ''}
        aria-current={i === at ? 'step' : undefined}
      >
        {title}
      </li>
    ))}
  </ol>
);
