import { artifactAddress } from '../../api/services';
import type { Job, PlannedDip } from '../../api/types';
import { jobPath } from '../../route';
import { may } from '../../state/session';
import { Button } from '../../ui/controls';
import { numberOf } from '../../ui/job_text';
import { WarningLines } from '../../ui/warning';
import { compute } from './actions';
import { dipPath, filesOf, stateClass, stateText } from './steps';

const kPictures = {
  stretch: 'Pose and stretch',
  mask: 'Share of the picture',
  film: 'Film image',
} as const;

/** One dip of a plan: its pictures, files and state. The warnings of the next one are beside its step. */
export function DipRow(props: { plan: Job; dip: PlannedDip; isNext: boolean }) {
  const { plan, dip } = props;
  const files = filesOf(plan.name, dip);
  return (
    <li aria-current={props.isNext ? 'step' : undefined}>
      <h3>
        Dip {dip.immersion} <span class={`state ${stateClass(dip)}`}>{stateText(dip)}</span>
      </h3>
      {!props.isNext && <Warnings dip={dip} />}
      <div class="thumbnails">
        {Object.entries(kPictures).map(([kind, text]) => (
          <figure key={kind}>
            <a href={artifactAddress(files.job, files.name(kind), true)}>
              <img
                src={artifactAddress(files.job, files.name(kind), true)}
                alt={`${text} of dip ${dip.immersion}`}
                loading="lazy"
              />
            </a>
            <figcaption>{text}</figcaption>
          </figure>
        ))}
      </div>
      <p class="row">
        <Downloads plan={plan} dip={dip} />
        {!props.isNext && <Again plan={plan} dip={dip} />}
      </p>
    </li>
  );
}

/** What is wrong with the dip or with its film. The role is that of the trouble, which begins while the page is open. */
export function Warnings({ dip, role }: { dip: PlannedDip; role?: 'alert' }) {
  return (
    <>
      {dip.trouble && (
        <p class="warning" role={role}>
          {dip.trouble}.
        </p>
      )}
      <WarningLines warnings={dip.warnings} />
    </>
  );
}

function Downloads({ plan, dip }: { plan: Job; dip: PlannedDip }) {
  const files = filesOf(plan.name, dip);
  const film = files.name('film');
  return (
    <>
      <a href={artifactAddress(files.job, film)} download={film}>
        {dip.simulateJob ? 'Film image' : 'Film image for the planned pose'}
      </a>
      <PdfLink dip={dip} />
      {dip.simulateJob && <a href={jobPath(dip.simulateJob)}>Job {numberOf(dip.simulateJob)}</a>}
      {dip.dipJob && <a href={jobPath(dip.dipJob)}>Dip record</a>}
    </>
  );
}

/** The pages to print; nothing until they are laid out. */
export const PdfLink = ({ dip: { immersion, printImageJob } }: { dip: PlannedDip }) =>
  printImageJob ? (
    <a href={artifactAddress(printImageJob, 'print.pdf')} download={`dip-${immersion}.pdf`}>
      PDF to print
    </a>
  ) : null;

/** Secondary actions of a dip that is not the next one. */
function Again({ plan, dip }: { plan: Job; dip: PlannedDip }) {
  if (dip.step === 'WAIT' || dip.step === 'CONFIRM') return null;
  return (
    <>
      {may('MAKER') && (
        <Button onPress={() => compute(plan, dip)}>
          {dip.simulateJob ? 'Compute again' : 'Compute for the planned pose'}
        </Button>
      )}
      {dip.simulateJob && may('OPERATOR') && (
        <a class="button" href={dipPath(dip)}>
          {dip.step === 'DONE' ? 'Dip again' : 'Dip now'}
        </a>
      )}
    </>
  );
}
