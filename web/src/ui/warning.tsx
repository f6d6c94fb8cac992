/** Shows warnings of the API, the same on every screen. */
import type { Place, Warning } from '../api/types';
import { Icon } from './icon';

/** A place in words, as words_of() in sim/base/result.cpp has them; empty if there is none. */
export function wordsOfPlace(place: Place | undefined): string {
  const { dip, filmPoint, immersionMm, file, layer, sheet, marker } = place ?? {};
  const depth_mm = filmPoint?.immersionMm ?? immersionMm;
  return [
    dip && `dip ${dip}`,
    depth_mm !== undefined && `${depth_mm.toFixed(2)} mm immersion`,
    filmPoint && `at (${filmPoint.xMm.toFixed(2)}, ${filmPoint.yMm.toFixed(2)}) mm`,
    place?.surface && 'surface',
    file && `${file.name}${file.line > 0 ? `, line ${file.line}` : ''}`,
    layer !== undefined && `layer ${layer}`,
    sheet !== undefined && `sheet ${sheet}`,
    marker !== undefined && `marker ${marker}`,
    place?.resource,
    place?.item,
  ]
    .filter(Boolean)
    .join(', ');
}

/** A warning and its place. */
export const WarningText = ({ warning: { message, where } }: { warning: Warning }) => {
  const place = wordsOfPlace(where);
  return (
    <span>
      {message}.{place && <span class="quiet"> {place}</span>}
    </span>
  );
};

/** Warnings as paragraphs. */
export const WarningLines = ({ warnings }: { warnings: readonly Warning[] }) => (
  <>
    {warnings.map((warning, i) => (
      <p class="warning" key={i}>
        <WarningText warning={warning} />
      </p>
    ))}
  </>
);

/** Warnings as a list. */
export const WarningList = ({ warnings }: { warnings: readonly Warning[] }) => (
  <ul class="problems">
    {warnings.map((warning, i) => (
      <li key={i}>
        <Icon name="warning" /> <WarningText warning={warning} />
      </li>
    ))}
  </ul>
);
