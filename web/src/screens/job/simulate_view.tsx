import { useEffect, useRef, useState } from 'preact/hooks';
import { warningsOf, type Warning } from '../../model/report';
import { formatFactor, formatMm, formatSeconds, formatShare } from '../../model/units';
import { Figures, Switch } from '../../ui/controls';
import { Icon } from '../../ui/icon';
import type { ResultView } from '../../view3d/result_view';
import { Files } from './files';
import { FilmViewer } from './film_viewer';
import { ObjectViewer } from './object_viewer';
import type { Results } from './results';

type Tab = 'film' | 'object' | 'files';

/** A finished simulation: film image, predicted object, warnings and figures. */
export function SimulateView({ results }: { results: Results }) {
  const [tab, setTab] = useState<Tab>('film');
  const [pointed, setPointed] = useState<Warning>();
  const report = results.report.value;
  const isWhole = results.has('film.png');
  return (
    <div class="columns result">
      <div>
        <Switch<Tab>
          label="Show"
          value={tab}
          onValue={setTab}
          choices={[
            ...(isWhole ? [{ value: 'film' as const, label: 'Film image' }] : []),
            { value: 'object', label: 'Object' },
            { value: 'files', label: 'Files' },
          ]}
        />
        {tab === 'film' && isWhole && <FilmTab results={results} />}
        {tab === 'object' && report && <ObjectViewer results={results} pointed={pointed} />}
        {tab === 'files' && <Files results={results} />}
      </div>
      <div>
        <Warnings
          results={results}
          pointed={pointed}
          point={(warning) => {
            setPointed(warning);
            setTab('object');
          }}
        />
        {report && (
          <section>
            <h2>Figures</h2>
            <Figures
              rows={[
                report.coverage !== undefined && ['Coverage', formatShare(report.coverage)],
                report.depth_mm !== undefined && ['Depth', formatMm(report.depth_mm)],
                report.stretch !== undefined && [
                  'Stretch (median)',
                  formatFactor(report.stretch.p50),
                ],
                report.stretch !== undefined && [
                  'Stretch (95th percentile)',
                  formatFactor(report.stretch.p95),
                ],
                report.stretch !== undefined && [
                  'Stretch (maximum)',
                  formatFactor(report.stretch.max),
                ],
                !!report.error && [
                  'Error on the film (median)',
                  report.error.p50_mm === null ? 'not known' : formatMm(report.error.p50_mm, 2),
                ],
                !!report.error && [
                  'Error on the film (95th percentile)',
                  report.error.p95_mm === null ? 'not known' : formatMm(report.error.p95_mm, 2),
                ],
                !!report.error && [
                  'Points that may be off by more than a pixel',
                  formatShare(report.error.above_pixel_share),
                ],
                !!report.error?.no_bound_share && [
                  'Points behind torn film, without a bound',
                  formatShare(report.error.no_bound_share),
                ],
                ['Dip speed', `${report.parameters?.dip_speed_mm_per_s ?? '–'} mm/s`],
                ['Film', report.parameters?.film?.name ?? '–'],
                [
                  'Film image',
                  `${report.parameters?.film_image_px?.join(' × ') ?? '–'} px, ${report.parameters?.dpi ?? '–'} dpi`,
                ],
                ['Computing time', formatSeconds(report.total_seconds ?? NaN)],
              ]}
            />
          </section>
        )}
      </div>
    </div>
  );
}

function FilmTab({ results }: { results: Results }) {
  const [straight, setStraight] = useState<ImageBitmap>();
  const [isWanted, setWanted] = useState(false);
  const arrived = useRef<() => void>();
  useEffect(() => results.loadFilm(), [results, results.report.value]);
  const film = results.film.value;
  if (!film) return <p class="quiet">Fetching the film image…</p>;
  const shape = results.filmShape();
  const draw = async (view: ResultView) => {
    if (straight || !shape) return;
    // As fine as the film image, but within the size that graphics cards support.
    const pitch = Math.max(film.pitch_mm, Math.max(shape.width_mm, shape.height_mm) / 4096);
    setStraight(await view.straightDown(shape, pitch));
    setWanted(false);
    arrived.current?.();
  };
  return (
    <>
      <FilmViewer
        film={film}
        straight={straight}
        computeStraight={() => {
          setWanted(true);
          return new Promise((resolve) => (arrived.current = resolve));
        }}
      />
      {isWanted && (
        <div class="offscreen" aria-hidden="true">
          <ObjectViewer results={results} pointed={undefined} onView={(view) => void draw(view)} />
        </div>
      )}
    </>
  );
}

function Warnings(props: {
  results: Results;
  pointed: Warning | undefined;
  point: (warning: Warning | undefined) => void;
}) {
  const { pointed, point } = props;
  const warnings = warningsOf(props.results.report.value);
  if (!props.results.report.value) return null;
  return (
    <section aria-labelledby="warnings-title">
      <h2 id="warnings-title">Warnings</h2>
      {warnings.length === 0 && <p>None. The print should look as predicted.</p>}
      <ul class="warnings">
        {warnings.map((warning) => (
          <li key={warning.code + warning.where + warning.message}>
            <button
              type="button"
              class="plain"
              aria-pressed={warning === pointed}
              title="Show on the object"
              onClick={() => point(warning === pointed ? undefined : warning)}
            >
              <Icon name="warning" />
              <span>
                {warning.message}.{warning.where && <span class="quiet"> {warning.where}</span>}
              </span>
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
