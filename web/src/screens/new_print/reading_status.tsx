import { Progress } from '../../ui/controls';
import { cancel } from './intake';
import { stage } from './reading';

/** What happens to the model that was dropped; nothing if it is there. */
export function ReadingStatus() {
  if (!stage.value) return null;
  const { text, share } = stage.value;
  return (
    <div class="reading" role="status">
      <p>{share === undefined ? `${text}…` : `${text} (${Math.round(100 * share)} %)`}</p>
      <Progress share={share} label={text} />
      <button type="button" onClick={cancel}>
        Cancel
      </button>
    </div>
  );
}
