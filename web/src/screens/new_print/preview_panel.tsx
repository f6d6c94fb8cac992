import { useEffect } from 'preact/hooks';
import { formatFactor, formatSeconds, formatShare } from '../../model/units';
import { Figures } from '../../ui/controls';
import { Icon } from '../../ui/icon';
import { followPreview, refusal, shown } from './preview';

/** Preview of the print in the current pose. */
export function PreviewPanel() {
  useEffect(followPreview, []);
  if (refusal.value) return <p class="warning">{refusal.value}</p>;
  const now = shown.value;
  if (!now) return null;
  return (
    <section aria-labelledby="preview-title" aria-live="polite">
      <h2 id="preview-title">Preview</h2>
      <Figures
        rows={[
          ['Coverage', formatShare(now.coverage)],
          ['Stretch (95th percentile)', formatFactor(now.stretchP95)],
          ['Computing time', formatSeconds(now.seconds)],
        ]}
      />
      <ul class="problems">
        {now.warnings.map(({ code, message, where }) => (
          <li key={code + where}>
            <Icon name="warning" /> {message}.
          </li>
        ))}
      </ul>
    </section>
  );
}
