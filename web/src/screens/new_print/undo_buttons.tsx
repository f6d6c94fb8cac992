import { canRedo, canUndo, redo, undo } from './undo';

/** Undo and redo. A button without effect stays focusable, so that the keyboard does not lose its place. */
export const UndoButtons = () => (
  <span class="group" role="group" aria-label="Changes of pose and picture">
    <button
      type="button"
      class="plain"
      aria-disabled={!canUndo.value}
      title="Undo (Ctrl+Z)"
      onClick={undo}
    >
      Undo
    </button>
    <button
      type="button"
      class="plain"
      aria-disabled={!canRedo.value}
      title="Redo (Ctrl+Shift+Z)"
      onClick={redo}
    >
      Redo
    </button>
  </span>
);
