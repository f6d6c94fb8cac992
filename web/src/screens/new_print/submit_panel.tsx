import { signal } from '@preact/signals';
import { jobs as jobsApi } from '../../api/services';
import { upload } from '../../api/uploads';
import { remedyForMissing } from '../../model/arrangement';
import { dipsOf } from '../../model/dips';
import type { Pose } from '../../model/pose';
import { done, refused, wordsOf, type Failure, type Result } from '../../model/result';
import { go } from '../../route';
import { remember } from '../../state/jobs';
import { complain } from '../../state/notices';
import { may } from '../../state/session';
import { Progress } from '../../ui/controls';
import { markRefused, remedyOf, useFormErrors } from '../../ui/field_errors';
import { calibrated, staleness } from './calibration';
import { centre_mm, change, draft, film, jobOf, shape, type Inputs } from './draft';
import { arrangement, colourless, inputsOf } from './intake';
import { pictureOf } from './picture/spec';

interface Sending {
  name: string;
  share: number;
  isLost: boolean;
}

const sending = signal<Sending | undefined>(undefined);
const failure = signal<Failure | undefined>(undefined);
let abortController: AbortController | undefined;

/** Uploads all files and creates the job. */
async function submit(): Promise<void> {
  abortController = new AbortController();
  failure.value = undefined;
  markRefused('job');
  if (!draft.value.requestId) change({});
  const result = await send(abortController.signal);
  sending.value = undefined;
  if (!result.ok) {
    if (result.failure.reason === 'ABORTED_HERE') return;
    failure.value = result.failure;
    markRefused('job', result.failure.violations);
    return complain(result.failure);
  }
  change({});
  go(`/${result.value}`);
}

async function send(signal: AbortSignal): Promise<Result<string>> {
  const value = draft.value;
  const inputs = await bring(signal);
  if (!inputs.ok) return inputs;
  sending.value = { name: 'the job', share: 1, isLost: false };
  const job = jobOf(value, inputs.value, centre_mm.value);
  const answer = await jobsApi.create(job, value.requestId);
  if (!answer.ok) return answer;
  remember(answer.value);
  return done(answer.value.name);
}

async function bring(signal: AbortSignal): Promise<Result<Inputs>> {
  const { files, from } = draft.value;
  const brought = { mesh: undefined, texture: undefined, profile: undefined } as Partial<Inputs>;
  const extraFiles: Inputs['extraFiles'] = [];
  for (const { role, name, file } of inputsOf(files)) {
    sending.value = { name, share: 0, isLost: false };
    const asset = await upload(
      file,
      (share, isLost) => (sending.value = { name, share, isLost }),
      signal,
    );
    if (!asset.ok) return asset;
    const input = { name, asset: asset.value };
    if (role === 'extra') extraFiles.push(input);
    else brought[role] = input;
  }
  const spec = brought.mesh ? undefined : from?.spec;
  const mesh = brought.mesh ?? (spec?.mesh as Inputs['mesh'] | undefined);
  if (!mesh) return refused('the model is missing', 'Drop a model, or choose a sample');
  const known = spec && pictureOf(spec);
  const texture = brought.texture ?? known?.texture;
  const paint = texture ? undefined : (spec?.paint as Inputs['paint']);
  const hasOwnColours = known?.hasOwnColours ?? arrangement.value.hasOwnColours;
  const profile = brought.profile ?? (spec?.profile as Inputs['profile']);
  const kept = (spec?.extraFiles ?? []) as Inputs['extraFiles'];
  const names = new Set(extraFiles.map((file) => file.name));
  return done({
    mesh,
    extraFiles: [...extraFiles, ...kept.filter((file) => !names.has(file.name))],
    ...(texture ? { texture, hasOwnColours } : {}),
    ...(paint ? { paint } : {}),
    ...(profile ? { profile } : {}),
  });
}

function isBeside({ centre_mm: [x, y] }: Pose): boolean {
  const { width_mm, height_mm } = film.value;
  return Math.abs(x) > width_mm / 2 || Math.abs(y) > height_mm / 2;
}

/** True if the film would stay blank. */
function lacksColours(): boolean {
  const { spec } = draft.value.from ?? {};
  const hasOwn = shape.value?.summary.hasColour;
  return !hasOwn && !arrangement.value.texture && !spec?.texture && !spec?.paint;
}

/** Returns the reason why the draft cannot be submitted; undefined if it can. */
function obstacle(): string | undefined {
  if (!shape.value) return 'Drop a model, or choose a sample';
  const remedy = remedyForMissing(arrangement.value.missing);
  if (remedy) return remedy;
  if (colourless.value.length > 0) return 'Correct the colours of the model, or choose a texture';
  if (lacksColours()) return 'Add a picture, because the model has no colours';
  const poses = calibrated.value
    ? [calibrated.value.pose]
    : dipsOf(draft.value).map(({ pose }) => pose);
  const beside = poses.findIndex(isBeside);
  if (beside >= 0)
    return `The object is beside the film${poses.length > 1 ? ` in dip ${beside + 1}` : ''}. Move it over the film`;
  const calibration = calibrated.value?.calibration;
  if (calibration && staleness(calibration))
    return 'The calibration is no longer valid. Calibrate again, or enter the pose manually';
  return undefined;
}

export function Submit() {
  const errors = useFormErrors();
  if (sending.value) return <Underway {...sending.value} />;
  const why = obstacle() ?? remedyOf(errors);
  const count = dipsOf(draft.value).length;
  return (
    <div class="submit">
      {failure.value && (
        <p class="error" role="alert">
          {wordsOf(failure.value)}.
        </p>
      )}
      <button
        type="button"
        class="primary large"
        disabled={why !== undefined || !may('MAKER')}
        aria-describedby="submit-why"
        onClick={() => void submit()}
      >
        {count > 1 ? `Compute ${count} dips` : 'Simulate'}
      </button>
      <p class="quiet" id="submit-why">
        {why ?? 'Computes the film image in seconds to minutes. Nothing is printed or moved yet.'}
      </p>
    </div>
  );
}

function Underway({ name, share, isLost }: Sending) {
  return (
    <div class="submit" role="status">
      <p>
        {isLost ? `Connection lost; the upload of ${name} will resume` : `Uploading ${name}`} (
        {Math.round(100 * share)} %)
      </p>
      <Progress share={share} label={`Uploading ${name}`} />
      <button type="button" onClick={() => abortController?.abort()}>
        Cancel
      </button>
    </div>
  );
}
