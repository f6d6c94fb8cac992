import { useEffect } from 'preact/hooks';
import { formatFactor, formatSeconds, formatShare } from '../../model/units';
import { Figures } from '../../ui/controls';
import { Icon } from '../../ui/icon';
import { followPreview, refusal, shown } from './preview';

/** What the print would be like as the object hangs now. */
export function PreviewPanel() {
  useEffect(followPreview, []);
  if (refusal.value) return <p class="warning">{refusal.value}</p>;
  const now = shown.value;
  if (!now) return null;
  return (
    <section aria-labelledby="preview-title" aria-live="polite">
      <h2 id="preview-title">As it hangs now</h2>
      <Figures
        rows={[
          ['Surface reached', formatShare(now.coverage)],
          ['Stretch, 95 % below', formatFactor(now.stretchP95)],
          ['Estimated in', formatSeconds(now.seconds)],
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
