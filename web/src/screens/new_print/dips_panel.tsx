import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import * as dips from '../../model/dips';
import { toAngles } from '../../model/pose';
import { formatFactor, formatShare } from '../../model/units';
import { Icon } from '../../ui/icon';
import { calibrated } from './calibration';
import { change, draft } from './draft';
import { view } from './mode';
import { figuresOf } from './preview';
import { followThumbnails } from './thumbnails';

/** The dips among which the picture is divided; nothing for a print of one dip. */
export function DipList() {
  const list = useRef<HTMLOListElement>(null);
  const moved = useRef<{ to: number; by: Step }>();
  useEffect(() => followThumbnails(() => list.current?.querySelectorAll('canvas') ?? []), []);
  // The focus stays on the dip that was moved, so that it can be moved on.
  useLayoutEffect(() => {
    if (moved.current) focusMove(list.current, moved.current);
    moved.current = undefined;
  });
  const all = dips.dipsOf(draft.value);
  if (all.length === 1) return null;
  const move = (at: number, by: Step) => {
    moved.current = { to: at + by, by };
    change(dips.move(draft.value, at, at + by));
  };
  return (
    <ol class="files dips" ref={list}>
      {all.map((dip, k) => (
        <Dip key={k} dip={dip} at={k} isLast={k === all.length - 1} move={(by) => move(k, by)} />
      ))}
    </ol>
  );
}

/** One place up or down in the list. */
type Step = -1 | 1;

const kMoves = [
  { by: -1, icon: 'up' },
  { by: 1, icon: 'down' },
] as const;

/** Focuses the button that was pressed, at its new place; at the end of the list, the other one. */
function focusMove(list: Element | null, { to, by }: { to: number; by: Step }): void {
  const buttons = [...(list?.children[to]?.querySelectorAll<HTMLButtonElement>('.move') ?? [])];
  const order = by === 1 ? buttons.reverse() : buttons;
  order.find((button) => !button.disabled)?.focus();
}

export function AddDip() {
  if (calibrated.value) return null;
  const count = dips.dipsOf(draft.value).length;
  return (
    <>
      <button
        type="button"
        disabled={count >= dips.kMostDips}
        onClick={() => change(dips.add(draft.value))}
      >
        Add another dip
      </button>
      <p class="quiet">
        {count > 1
          ? `Each place is printed by the dip that stretches the film least there. At most ${dips.kMostDips} dips.`
          : 'For sides that the film does not reach in this pose.'}
      </p>
    </>
  );
}

interface DipProps {
  dip: dips.Dip;
  at: number;
  isLast: boolean;
  move: (by: Step) => void;
}

function Dip({ dip, at, isLast, move }: DipProps) {
  const isSelected = at === draft.value.before.length;
  const isAtEnd = { [-1]: at === 0, [1]: isLast };
  return (
    <li>
      <button
        type="button"
        class="plain name"
        aria-pressed={isSelected}
        onClick={() => change(dips.select(draft.value, at))}
      >
        {view.value && <canvas width={112} height={112} aria-hidden="true" />}
        Dip {at + 1}
      </button>
      <span class="quiet">
        {figuresText(dip) ?? anglesText(dip)}
        {dip.depth_mm !== undefined && `, ${dip.depth_mm}\u00a0mm deep`}
      </span>
      {kMoves.map(({ by, icon }) => (
        <button
          type="button"
          key={icon}
          class="plain move"
          aria-label={`Move dip ${at + 1} ${icon}`}
          disabled={isAtEnd[by]}
          onClick={() => move(by)}
        >
          <Icon name={icon} />
        </button>
      ))}
      <button
        type="button"
        class="plain"
        aria-label={`Remove dip ${at + 1}`}
        onClick={() => change(dips.remove(draft.value, at))}
      >
        <Icon name="close" />
      </button>
    </li>
  );
}

/** The preview of a dip; undefined if there was none since the object or the film changed. */
function figuresText(dip: dips.Dip): string | undefined {
  const figures = figuresOf(dip);
  return (
    figures && `reach ${formatShare(figures.coverage)}, stretch ${formatFactor(figures.stretchP95)}`
  );
}

const anglesText = ({ pose }: dips.Dip): string =>
  `turned ${toAngles(pose.rotation)
    .map((angle) => `${Math.round(angle)}°`)
    .join(', ')}`;
