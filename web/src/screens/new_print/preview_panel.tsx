import { useEffect } from 'preact/hooks';
import type { Warning } from '../../api/types';
import { formatFactor, formatSeconds, formatShare } from '../../model/units';
import { Figures, Progress } from '../../ui/controls';
import { WarningList } from '../../ui/warning';
import { draft, shape } from './draft';
import { followPreview, isComputing, shown, trouble } from './preview';

/** Previews are Stokes flow, even if the print will be computed by another model. */
const kOfStokes: readonly Warning['code'][] = ['STRETCH_BEYOND_STOKES', 'DRAG_IGNORED'];

/** Preview of the print in the current pose. */
export function PreviewPanel() {
  useEffect(followPreview, []);
  if (trouble.value)
    return (
      <p class="warning" role="status">
        No preview: {trouble.value}.
      </p>
    );
  const now = shown.value;
  if (!now && !isComputing.value) return null;
  const known = new Set(shape.value?.summary.warnings.map(({ message }) => message));
  const isStokes = draft.value.model === 'MODEL_STOKES';
  return (
    <section aria-labelledby="preview-title" aria-live="polite">
      <h2 id="preview-title">Preview</h2>
      <div class={isComputing.value ? 'busy' : 'busy done'}>
        <Progress share={undefined} label="Computing the preview" />
      </div>
      {!now && <p>Computing the preview…</p>}
      {now && (
        <Figures
          rows={[
            ['Coverage', formatShare(now.coverage)],
            ['Stretch (95th percentile)', formatFactor(now.stretchP95)],
            ['Computing time', formatSeconds(now.seconds)],
          ]}
        />
      )}
      <WarningList
        warnings={(now?.warnings ?? []).filter(
          ({ code, message }) => !known.has(message) && (isStokes || !kOfStokes.includes(code)),
        )}
      />
    </section>
  );
}
