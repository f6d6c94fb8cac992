import { useEffect, useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { jobs as api, newRequestId } from '../../api/services';
import type { DipSpecInput } from '../../api/types';
import { limitsOf } from '../../model/limits';
import { jobPath } from '../../route';
import { known, refresh, remember } from '../../state/jobs';
import { orNotify } from '../../state/notices';
import { isOurs, leaseId, refreshRig, rig } from '../../state/rig';
import { Button, NumberField } from '../../ui/controls';
import { FieldErrorsOf, remedyOf, useFieldErrors } from '../../ui/field_errors';
import { numberOf } from '../../ui/job_text';

const kFirst: Record<string, string> = {
  OFFLINE: 'The rig is offline.',
  DISARMED: 'Arm and home the rig first.',
  UNHOMED: 'Home the rig first.',
  FAULT: 'Reset the rig, then arm and home it first.',
  ESTOPPED: 'Release the stop button, then reset, arm and home the rig first.',
};

/** What must be done before a dip can start. */
function first(): string {
  if (!isOurs.value) return 'Take control of the rig first.';
  return kFirst[rig.value?.state ?? ''] ?? 'Wait until the axis has stopped.';
}

/** Starts the guided dip for a film image. */
export function BeginDip({ simulateJob }: { simulateJob: string }) {
  const [requestId] = useState(newRequestId);
  const [spec, setSpec] = useState<DipSpecInput>({});
  const errors = useFieldErrors();
  useEffect(() => void refresh(simulateJob), [simulateJob]);
  const simulated = known.value.get(simulateJob);
  const isReady = isOurs.value && rig.value?.state === 'IDLE';
  const remedy = remedyOf(errors);
  const begin = async () => {
    const job = orNotify(
      await api.create({ dip: { ...spec, simulateJob } }, requestId, leaseId.value),
    );
    if (!job) return;
    remember(job);
    await refreshRig();
  };
  const field = (
    key: 'soakS' | 'activatorWaitS' | 'holdS' | 'clearanceMm' | 'waterTemperatureC',
    label: string,
    placeholder?: string,
  ) => (
    <NumberField
      label={label}
      {...limitsOf(rules.DipSpec[key])}
      {...(placeholder ? { placeholder } : {})}
      value={spec[key]}
      onValue={(value) => setSpec({ ...spec, [key]: value })}
      onEmpty={() => setSpec({ ...spec, [key]: undefined })}
    />
  );
  return (
    <section class="dip" aria-labelledby="begin-title">
      <h2 id="begin-title">Dip</h2>
      <p>
        Dips with the film image of{' '}
        <a href={jobPath(simulateJob)}>{simulated?.displayName || simulateJob}</a> (
        {numberOf(simulateJob)}), step by step: print the film, mount the object, lay the film on
        the water, spray the activator, dip.
      </p>
      <details>
        <summary>Dip settings</summary>
        <FieldErrorsOf value={errors}>
          <div class="row">
            {field('soakS', 'Soak time')}
            {field('activatorWaitS', 'Activation time')}
            {field('holdS', 'Hold time at depth')}
            {field('clearanceMm', 'Clearance for the film')}
            {field('waterTemperatureC', 'Water temperature', 'for the record')}
          </div>
        </FieldErrorsOf>
      </details>
      <Button kind="primary" disabled={!isReady || remedy !== undefined} onPress={begin}>
        Start the dip
      </Button>
      {remedy && <p class="error">{remedy}.</p>}
      {!isReady && (
        <p class="quiet">{first()} The dip moves nothing until you confirm each step.</p>
      )}
    </section>
  );
}
