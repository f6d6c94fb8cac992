import { useEffect, useState } from 'preact/hooks';
import { artifactAddress, imageAddress } from '../../api/services';
import type { Job, PlannedDip } from '../../api/types';
import { beginnings } from '../../events';
import { againPath } from '../../route';
import { rig } from '../../state/rig';
import { may } from '../../state/session';
import { Button } from '../../ui/controls';
import { dipText } from '../../ui/job_text';
import { DipRow, PdfLink, Warnings } from './dip_row';
import { follow, progress } from './progress';
import { take } from './actions';
import { actionText, needsHoming, nextOf, pageOf, rigPath, roleFor } from './steps';

/** A computed plan: its next step, and all dips. */
export function PlanView({ job }: { job: Job }) {
  useEffect(() => follow(job.name), [job.name, beginnings.value]);
  const now = progress.value;
  if (now?.planJob !== job.name) return <p class="quiet">Loading the dips…</p>;
  const next = nextOf(now);
  return (
    <>
      {next ? <Next plan={job} dip={next} dips={now.dips.length} /> : <AllDone />}
      <section aria-labelledby="dips-title">
        <h2 id="dips-title">Dips</h2>
        {may('MAKER') && now.dips.every(({ step }) => step !== 'DONE') && (
          <p>
            <a href={againPath(job.name)}>Change the order or the poses</a>
          </p>
        )}
        <ol class="plan">
          {now.dips.map((dip) => (
            <DipRow key={dip.immersion} plan={job} dip={dip} isNext={dip === next} />
          ))}
        </ol>
      </section>
      <figure class="combined">
        <img
          src={artifactAddress(job.name, 'combined.png', true)}
          alt="The object after all dips, as predicted"
          loading="lazy"
        />
        <figcaption class="quiet">The object after all dips, as predicted</figcaption>
      </figure>
    </>
  );
}

/** The next step of the plan, with the only primary button of the page. */
function Next({ plan, dip, dips }: { plan: Job; dip: PlannedDip; dips: number }) {
  // Calibrating has two jobs, between which the button stays the same.
  const [isBusy, setBusy] = useState(false);
  const act = async () => {
    setBusy(true);
    await take(plan, dip);
    setBusy(false);
  };
  const isHomingFirst = needsHoming(dip, rig.value) && !isBusy;
  const page = isHomingFirst ? rigPath(plan) : isBusy ? undefined : pageOf(dip);
  const isAllowed = may(roleFor(dip));
  return (
    <section class="dip next" aria-labelledby="next-title">
      <h2 id="next-title">{dipText(dip.immersion, dips)}</h2>
      <p class="instruction" role="status">
        {dip.instruction}
      </p>
      <Warnings dip={dip} role="alert" />
      {dip.step === 'CALIBRATE' && <PlannedPose dip={dip} />}
      {dip.step === 'DIP' && (
        <p>
          <PdfLink dip={dip} />
        </p>
      )}
      {isHomingFirst && (
        <p class="warning">
          The rig is not homed. Arm and home it before you calibrate, because homing makes a
          calibration invalid.
        </p>
      )}
      {page && isAllowed ? (
        <a class="button primary large" href={page}>
          {isHomingFirst ? 'Prepare the rig' : actionText(dip)}
        </a>
      ) : (
        <Button kind="primary" disabled={!isAllowed} onPress={act}>
          {isBusy ? 'Working…' : actionText(dip)}
        </Button>
      )}
      {dip.step === 'CALIBRATE' && !isHomingFirst && (
        <p class="quiet">
          The camera must see the object. If it is near the water, raise it on the{' '}
          <a href={rigPath(plan)}>Rig page</a> first.
        </p>
      )}
      {!isAllowed && (
        <p class="quiet">
          This step needs the role {roleFor(dip) === 'MAKER' ? 'Maker' : 'Operator'}.
        </p>
      )}
    </section>
  );
}

const PlannedPose = ({ dip }: { dip: PlannedDip }) => (
  <img
    class="planned-pose"
    src={imageAddress(dip.picture)}
    alt={`The planned pose of dip ${dip.immersion}`}
  />
);

const AllDone = () => (
  <section class="dip next">
    <h2>All dips are done</h2>
    <p class="instruction">Wash the object and let it dry.</p>
    <a class="button primary large" href="#/">
      New print
    </a>
  </section>
);
