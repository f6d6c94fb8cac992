import { useEffect, useState } from 'preact/hooks';
import { calibrations as api } from '../../api/services';
import type { Calibration, Job } from '../../api/types';
import { formatMm } from '../../model/units';
import { Figures } from '../../ui/controls';
import { staleness } from '../new_print/calibration';
import { numberOf } from '../../ui/job_text';
import { WarningLines } from '../../ui/warning';
import { Files, Pictures } from './files';
import type { Results } from './results';

/** Results of a calibration job: the measured pose and its error, or the camera calibration. */
export function CalibrateView({ job, results }: { job: Job; results: Results }) {
  const [found, setFound] = useState<Calibration>();
  useEffect(() => {
    void api.list().then((page) => {
      if (page.ok) setFound(page.value.calibrations.find((one) => one.job === job.name));
    });
  }, [job.name]);
  return (
    <>
      <WarningLines warnings={results.warnings} />
      <div class="columns">
        <div>
          <Pictures results={results} />
          <Files results={results} />
        </div>
        <div>{found && <Found calibration={found} />}</div>
      </div>
    </>
  );
}

const orDash = (value: number | undefined) => (value === undefined ? '–' : formatMm(value, 2));

function Found({ calibration }: { calibration: Calibration }) {
  const why = staleness(calibration);
  return (
    <section>
      <h2>
        Calibration {numberOf(calibration.name)} {calibration.active ? '(active)' : ''}
      </h2>
      {why && <p class="warning">This calibration is no longer valid: {why}. Calibrate again.</p>}
      {calibration.kind === 'CAMERA' ? (
        <Figures
          rows={[
            ['Views', String(calibration.views ?? 0)],
            ['Residual on the board (rms)', orDash(calibration.rmsMm)],
          ]}
        />
      ) : (
        <Figures
          rows={[
            ['Error on the surface (median)', orDash(calibration.errorP50Mm)],
            ['Error (95th percentile)', orDash(calibration.errorP95Mm)],
            ['Error (maximum)', orDash(calibration.errorMaxMm)],
            ['Height of the object above the water', orDash(calibration.heightMm)],
            ['Axis position at first contact', orDash(calibration.contactMm)],
            ['Water level', orDash(calibration.waterZMm)],
          ]}
        />
      )}
      {(calibration.symmetries ?? []).map((text) => (
        <p class="quiet" key={text}>
          Not measured, because it does not move the surface: {text}
        </p>
      ))}
      {(calibration.markers ?? []).length > 0 && <Markers markers={calibration.markers!} />}
    </section>
  );
}

const Markers = ({ markers }: { markers: NonNullable<Calibration['markers']> }) => (
  <table>
    <thead>
      <tr>
        <th scope="col">Marker</th>
        <th scope="col">Fit error (rms)</th>
        <th scope="col">Residual</th>
      </tr>
    </thead>
    <tbody>
      {markers.map((marker) => (
        <tr key={marker.name}>
          <th scope="row">{marker.name}</th>
          {marker.used ? (
            <>
              <td>{orDash(marker.rmsMm)}</td>
              <td>{orDash(marker.residualMm)}</td>
            </>
          ) : (
            <td colSpan={2}>not used: {marker.whyNot}</td>
          )}
        </tr>
      ))}
    </tbody>
  </table>
);
