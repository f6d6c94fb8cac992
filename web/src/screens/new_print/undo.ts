/** Undo and redo for the dips, the size and the picture of a new print. */
import { computed, effect, signal } from '@preact/signals';
import type { Dips } from '../../model/dips';
import { change, draft, shape } from './draft';
import { History } from './history';
import { meshOf } from './intake';
import type { LayerChoices } from './picture/choices';

interface Step extends Dips {
  layer: LayerChoices;
  scale: number;
}

const kParts = ['layer', 'pose', 'depth_mm', 'before', 'after', 'scale'] as const;
const stepOf = ({ layer, pose, depth_mm, before, after, scale }: Step): Step => ({
  layer,
  pose,
  depth_mm,
  before,
  after,
  scale,
});
const isSame = (a: Step, b: Step): boolean => kParts.every((part) => a[part] === b[part]);

// Another object begins another history.
const object = computed(() => shape.value && (meshOf(draft.value.files) ?? draft.value.from?.job));

let history = new History<Step>(stepOf(draft.value));
let ofObject: unknown;
/** Changes of the same action are one step. */
let action = {};

export const canUndo = signal(false);
export const canRedo = signal(false);

function tell(): void {
  canUndo.value = history.canUndo;
  canRedo.value = history.canRedo;
}

/** Starts a new step with the next change. */
export const nextStep = (): void => {
  action = {};
};

/** Records changes of the draft until the returned function is called. */
export const record = (): (() => void) =>
  effect(() => {
    const now = stepOf(draft.value);
    if (object.value !== ofObject) {
      ofObject = object.value;
      history = new History(now);
    } else if (!isSame(now, history.present)) {
      history.add(now, action);
    }
    tell();
  });

export function undo(): void {
  change(history.undo());
}

export function redo(): void {
  change(history.redo());
}

type Command = 'undo' | 'redo';

/** The command of a key; undefined for other keys, and in fields, which have an undo of their own. */
export function commandOf(
  event: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'shiftKey' | 'altKey'>,
  isTyping: boolean,
): Command | undefined {
  if (isTyping || event.altKey || !(event.ctrlKey || event.metaKey)) return undefined;
  const key = event.key.toLowerCase();
  if (key === 'z') return event.shiftKey ? 'redo' : 'undo';
  return key === 'y' && !event.shiftKey ? 'redo' : undefined;
}

const kTyped = 'input:not([type=radio], [type=checkbox], [type=range], [type=button]), textarea';

const isTyping = (target: EventTarget | null): boolean =>
  target instanceof Element && target.matches(kTyped);

const kWheelPause_ms = 600;

/** Listens for keys, and for the beginnings of actions, until the returned function is called. */
export function listenForUndo(): () => void {
  let lastWheel = -Infinity;
  const wheel = (event: Event) => {
    if (event.timeStamp - lastWheel > kWheelPause_ms) nextStep();
    lastWheel = event.timeStamp;
  };
  const press = (event: KeyboardEvent) => {
    const command = commandOf(event, isTyping(event.target));
    if (!command) return;
    event.preventDefault();
    if (command === 'undo') undo();
    else redo();
  };
  const beginnings = ['pointerdown', 'click', 'focusin', 'drop'] as const;
  beginnings.forEach((name) => window.addEventListener(name, nextStep, true));
  window.addEventListener('wheel', wheel, { capture: true, passive: true });
  window.addEventListener('keydown', press);
  return () => {
    beginnings.forEach((name) => window.removeEventListener(name, nextStep, true));
    window.removeEventListener('wheel', wheel, true);
    window.removeEventListener('keydown', press);
  };
}

/** Records steps while the page is shown. */
export function followSteps(): () => void {
  const ends = [record(), listenForUndo()];
  return () => ends.forEach((end) => end());
}
