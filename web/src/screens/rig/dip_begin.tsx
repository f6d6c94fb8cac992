import { useEffect, useState } from 'preact/hooks';
import { jobs as api, newRequestId } from '../../api/services';
import type { DipSpecInput } from '../../api/types';
import { jobPath } from '../../route';
import { known, refresh, remember } from '../../state/jobs';
import { orComplain } from '../../state/notices';
import { isOurs, leaseId, refreshRig, rig } from '../../state/rig';
import { Button, NumberField } from '../../ui/controls';
import { numberOf } from '../../ui/job_text';

/** Begins the guided dip of a film image. */
export function BeginDip({ simulateJob }: { simulateJob: string }) {
  const [requestId] = useState(newRequestId);
  const [spec, setSpec] = useState<DipSpecInput>({});
  useEffect(() => void refresh(simulateJob), [simulateJob]);
  const simulated = known.value.get(simulateJob);
  const isReady = isOurs.value && rig.value?.state === 'IDLE';
  const begin = async () => {
    const job = orComplain(
      await api.create({ dip: { ...spec, simulateJob } }, requestId, leaseId.value),
    );
    if (!job) return;
    remember(job);
    await refreshRig();
  };
  const field = (
    key: 'soakS' | 'activatorWaitS' | 'holdS' | 'clearanceMm' | 'waterTemperatureC',
    label: string,
    unit: string,
    usual: string,
    max: number,
  ) => (
    <NumberField
      label={label}
      unit={unit}
      value={spec[key]}
      placeholder={usual}
      min={0}
      max={max}
      onValue={(value) => setSpec({ ...spec, [key]: value })}
      onEmpty={() => setSpec({ ...spec, [key]: undefined })}
    />
  );
  return (
    <section class="dip" aria-labelledby="begin-title">
      <h2 id="begin-title">Dip</h2>
      <p>
        The film image of <a href={jobPath(simulateJob)}>{simulated?.displayName || simulateJob}</a>{' '}
        ({numberOf(simulateJob)}), step by step: printing, hanging, laying the film, activator,
        descent.
      </p>
      <details>
        <summary>Settings of the dip</summary>
        <div class="row">
          {field('soakS', 'Film soaks', 's', '60', 3600)}
          {field('activatorWaitS', 'Activator works', 's', '20', 3600)}
          {field('holdS', 'Hold at the depth', 's', '2', 600)}
          {field('clearanceMm', 'Room for the film', 'mm', '20', 200)}
          {field('waterTemperatureC', 'Water', '°C', 'for the record', 100)}
        </div>
      </details>
      <Button kind="primary" disabled={!isReady} onPress={begin}>
        Begin the dip
      </Button>
      {!isReady && (
        <p class="quiet">
          {isOurs.value ? 'Arm and home the rig first.' : 'Take the rig first.'} Nothing moves
          before you confirm its steps.
        </p>
      )}
    </section>
  );
}
