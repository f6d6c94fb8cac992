import { useEffect, useState } from 'preact/hooks';
import { route } from '../../route';
import { orNotify } from '../../state/notices';
import { may } from '../../state/session';
import { FieldErrorsOf, useFieldErrors } from '../../ui/field_errors';
import { refreshCalibrations } from './calibration';
import { draft, restore, shape, startFrom } from './draft';
import { shapeOfJob } from './from_job';
import { Intake, Taken, useDrop } from './intake_panel';
import { problems, reread, startOver } from './intake';
import { ObjectView } from './object_view';
import { PosePanel } from './pose_panel';
import { FilmPanel, MorePanel } from './settings_panel';
import { PreviewPanel } from './preview_panel';
import { stage } from './reading';
import { ReadingStatus } from './reading_status';
import { Submit } from './submit_panel';
import { followSteps } from './undo';

let isRestored = false;

/** Restores the draft, or starts from the job in the URL. */
async function prepare(from: string | null): Promise<void> {
  if (!isRestored) await restore();
  isRestored = true;
  if (from && draft.value.from?.job !== from) {
    if (!orNotify(await startFrom(from))) return;
  }
  await reread();
  if (draft.value.from && !shape.value) orNotify(await shapeOfJob());
}

export function NewPrint() {
  const from = route.value.query.get('from');
  const [isReady, setReady] = useState(false);
  useEffect(() => {
    void prepare(from).then(() => setReady(true));
    void refreshCalibrations();
  }, [from]);

  useEffect(followSteps, []);
  const errors = useFieldErrors();
  const isOver = useDrop();
  const hasObject = shape.value !== undefined;
  return (
    <div class="new-print">
      <h1 class="hidden">New print</h1>
      <div class={`scene ${isOver ? 'over' : ''}`}>
        {hasObject && <ObjectView />}
        {!hasObject && (stage.value ? <ReadingStatus /> : <Intake isBusy={!isReady} />)}
        {hasObject && isOver && (
          <p class="landing">A picture lands where you drop it on the object.</p>
        )}
      </div>
      <div class="panel">
        {!may('MAKER') && (
          <p class="note">
            You can view this page but not submit jobs. Ask an admin for the role Maker.
          </p>
        )}
        <FieldErrorsOf value={errors}>
          {hasObject || problems.value.length > 0 ? <Taken /> : <Instructions />}
          <PosePanel />
          {hasObject && <PreviewPanel />}
          <FilmPanel />
          <MorePanel />
          {hasObject && <Submit />}
        </FieldErrorsOf>
        {(hasObject || draft.value.files.length > 0 || draft.value.from) && (
          <button type="button" class="plain" onClick={startOver}>
            Start over
          </button>
        )}
      </div>
    </div>
  );
}

/** Instructions for first-time users. */
const Instructions = () => (
  <section>
    <h2>How it works</h2>
    <ol>
      <li>Drop a model and turn it to the pose in which it will be dipped.</li>
      <li>
        Simulate the dip. The film image is distorted so that it matches the object once the film
        has stretched.
      </li>
      <li>Print the image on film and dip the object. The Rig page guides you step by step.</li>
    </ol>
    <p class="quiet">Nothing is printed and nothing moves until you confirm.</p>
  </section>
);
