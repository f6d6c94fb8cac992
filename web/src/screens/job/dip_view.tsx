import { useEffect, useState } from 'preact/hooks';
import { fetchBytes } from '../../api/call';
import { artifactPath } from '../../api/services';
import type { Job } from '../../api/types';
import { readPositions, type Sample } from '../../model/positions';
import { isFinished } from '../../state/jobs';
import { formatSeconds } from '../../model/units';
import { Figures } from '../../ui/controls';
import { WarningLines } from '../../ui/warning';
import { Files } from './files';
import type { Results } from './results';

/** A dip: its record, or a link to the rig while it runs. */
export function DipView({ job, results }: { job: Job; results: Results }) {
  const [samples, setSamples] = useState<Sample[]>([]);
  const hasRecord = results.has('positions.csv');
  useEffect(() => {
    if (!hasRecord) return;
    void fetchBytes(artifactPath(job.name, 'positions.csv')).then((bytes) => {
      if (bytes.ok) setSamples(readPositions(new TextDecoder().decode(bytes.value)));
    });
  }, [hasRecord]);
  const status = job.dipStatus;
  const last = samples.at(-1);
  const planned = results.report.value?.dip?.parameters;
  return (
    <>
      {!isFinished(job) && (
        <p>
          <a class="button primary" href="#/rig">
            Continue on the Rig page
          </a>
        </p>
      )}
      {status?.instruction && <p class="instruction">{status.instruction}</p>}
      <WarningLines warnings={status?.warnings ?? []} />
      <Figures
        rows={[
          [
            'Simulation',
            job.dip?.simulateJob ? (
              <a href={`#/${job.dip.simulateJob}`}>{job.dip.simulateJob}</a>
            ) : (
              '–'
            ),
          ],
          ['Depth', `${planned?.depthMm ?? job.dip?.depthMm ?? '–'} mm`],
          ['Speed', `${planned?.speedMmPerS ?? job.dip?.speedMmPerS ?? '–'} mm/s`],
          status?.contactMm !== undefined && [
            'Axis position at first contact',
            `${status.contactMm.toFixed(2)} mm`,
          ],
          last !== undefined && ['Duration of the record', formatSeconds(last.t_s)],
        ]}
      />
      {samples.length > 1 && <Chart samples={samples} />}
      <Files results={results} />
    </>
  );
}

/** Axis position over time; lower positions are drawn lower. */
function Chart({ samples }: { samples: Sample[] }) {
  const t = samples.map((sample) => sample.t_s);
  const at = samples.map((sample) => sample.position_mm);
  const [t0, t1] = [t[0]!, t.at(-1)!];
  const low = Math.min(...at);
  const high = Math.max(...at);
  const x = (s: number) => 40 + (350 * (s - t0)) / (t1 - t0 || 1);
  const y = (mm: number) => 10 + (130 * (mm - low)) / (high - low || 1);
  const step = Math.max(1, Math.floor(samples.length / 700));
  const points = samples
    .filter((_, i) => i % step === 0 || i === samples.length - 1)
    .map((sample) => `${x(sample.t_s).toFixed(1)},${y(sample.position_mm).toFixed(1)}`);
  return (
    <svg
      class="chart"
      viewBox="0 0 400 165"
      role="img"
      aria-label={`Position over time: from ${low.toFixed(1)} to ${high.toFixed(1)} mm in ${formatSeconds(t1 - t0)}`}
    >
      <polyline points={points.join(' ')} />
      <text x="36" y={y(low) + 4} text-anchor="end">
        {low.toFixed(0)} mm
      </text>
      <text x="36" y={y(high) + 4} text-anchor="end">
        {high.toFixed(0)} mm
      </text>
      <text x={x(t0)} y="160">
        0 s
      </text>
      <text x={x(t1)} y="160" text-anchor="end">
        {(t1 - t0).toFixed(0)} s
      </text>
    </svg>
  );
}
