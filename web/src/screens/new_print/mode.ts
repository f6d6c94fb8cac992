/** What dragging in the 3D view does, and the view itself. */
import { computed, signal } from '@preact/signals';
import type { PoseView } from '../../view3d/pose_view';
import { isMovable } from './picture/placed';

export type Mode = 'rotate' | 'translate' | 'none' | 'picture';

const chosen = signal<Mode>('rotate');

/** The chosen mode, unless there is no picture to move. */
export const mode = computed<Mode>(() =>
  chosen.value === 'picture' && !isMovable.value ? 'rotate' : chosen.value,
);

export const setMode = (value: Mode): void => {
  chosen.value = value;
};

/** The 3D view that is shown. */
export const view = signal<PoseView | undefined>(undefined);

/** Counts how often the object in the view has changed other than by its pose. */
export const looks = signal(0);
