import { useEffect, useRef, useState } from 'preact/hooks';
import type { FlowFacts, Warning } from '../../api/types';
import { formatFactor, formatMm, formatSeconds, formatShare } from '../../model/units';
import { Figures, Switch, type Row } from '../../ui/controls';
import { Icon } from '../../ui/icon';
import { WarningText } from '../../ui/warning';
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
  const report = results.report.value?.simulate;
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
                ...(report.flow ? rowsOf(report.flow) : []),
                ['Dip speed', `${results.dip?.dipSpeedMmPerS ?? '–'} mm/s`],
                ['Film', results.dip?.film?.name ?? '–'],
                [
                  'Film image',
                  `${report.parameters?.filmImagePx.join(' × ') || '–'} px, ${report.parameters?.dpi ?? '–'} dpi`,
                ],
                ['Computing time', formatSeconds(report.run?.totalSeconds ?? NaN)],
              ]}
            />
          </section>
        )}
      </div>
    </div>
  );
}

const orUnknown = (length_mm: number | undefined) =>
  length_mm === undefined ? 'not known' : formatMm(length_mm, 2);

/** The figures of a dip. */
const rowsOf = ({ coverage, depthMm, stretch, error }: FlowFacts): Row[] => [
  ['Coverage', formatShare(coverage)],
  ['Depth', formatMm(depthMm)],
  stretch?.p50 !== undefined && ['Stretch (median)', formatFactor(stretch.p50)],
  stretch?.p95 !== undefined && ['Stretch (95th percentile)', formatFactor(stretch.p95)],
  stretch?.max !== undefined && ['Stretch (maximum)', formatFactor(stretch.max)],
  error && ['Error on the film (median)', orUnknown(error.p50Mm)],
  error && ['Error on the film (95th percentile)', orUnknown(error.p95Mm)],
  error && ['Points that may be off by more than a pixel', formatShare(error.abovePixelShare)],
  !!error?.noBoundShare && [
    'Points behind torn film, without a bound',
    formatShare(error.noBoundShare),
  ],
];

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
  const { warnings, report } = props.results;
  if (!report.value) return null;
  return (
    <section aria-labelledby="warnings-title">
      <h2 id="warnings-title">Warnings</h2>
      {warnings.length === 0 && <p>None. The print should look as predicted.</p>}
      <ul class="warnings">
        {warnings.map((warning, i) => (
          <li key={i}>
            <button
              type="button"
              class="plain"
              aria-pressed={warning === pointed}
              title="Show on the object"
              onClick={() => point(warning === pointed ? undefined : warning)}
            >
              <Icon name="warning" />
              <WarningText warning={warning} />
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
