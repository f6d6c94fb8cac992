import type { Rig } from '../../api/types';

/** Draws the axis from home (top) to its lower soft limit, with the current position. */
export function Gauge({ now }: { now: Rig }) {
  const { minMm = 0, maxMm = 1 } = now.axis ?? {};
  const at = now.positionMm;
  const place = (mm: number) => 8 + (184 * (mm - minMm)) / (maxMm - minMm);
  const marks = [0, 50, 100, 150, 200, 250, 300, 400, 500].filter(
    (mm) => mm >= minMm && mm <= maxMm,
  );
  return (
    <svg
      class="gauge"
      viewBox="0 0 110 200"
      role="img"
      aria-label={at === undefined ? 'Position unknown' : `Position ${at.toFixed(1)} mm`}
    >
      <line x1="40" x2="40" y1="8" y2="192" class="axis" />
      {marks.map((mm) => (
        <g key={mm}>
          <line x1="34" x2="40" y1={place(mm)} y2={place(mm)} class="axis" />
          <text x="30" y={place(mm) + 3} text-anchor="end">
            {mm}
          </text>
        </g>
      ))}
      {at !== undefined && (
        <g
          transform={`translate(0 ${place(Math.max(minMm, Math.min(maxMm, at)))})`}
          class={now.homed ? 'here' : 'here unsure'}
        >
          <path d="M42 0l9-6v12z" />
          <text x="54" y="4">
            {at.toFixed(1)} mm
          </text>
        </g>
      )}
    </svg>
  );
}
