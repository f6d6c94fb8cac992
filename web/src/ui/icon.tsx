/** Line icons on a 16 × 16 grid, in the text colour. */
const kPaths = {
  new: 'M3 13h10M8 2v8M4 6h8',
  jobs: 'M2 4h12M2 8h12M2 12h8',
  rig: 'M8 1v7M5 5l3 3 3-3M1 12q2-2 3.5 0t3.5 0 3.5 0 3.5 0',
  people: 'M8 7a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5M3 14q0-5 5-5t5 5',
  close: 'M4 4l8 8M12 4l-8 8',
  light:
    'M8 11a3 3 0 1 0 0-6 3 3 0 0 0 0 6M8 1v2M8 13v2M1 8h2M13 8h2M3 3l1.5 1.5M11.5 11.5 13 13M13 3l-1.5 1.5M4.500 11.500 3 13',
  dark: 'M13 10A6 6 0 0 1 6 3a5.500 5.500 0 1 0 7 7z',
  system: 'M2 3h12v8H2zM6 14h4',
  warning: 'M8 2 1 14h14zM8 6v4M8 12v.5',
  up: 'M8 13V3M4 7l4-4 4 4',
  down: 'M8 3v10M4 9l4 4 4-4',
} as const;

export type IconName = keyof typeof kPaths;

export const Icon = ({ name }: { name: IconName }) => (
  <svg class="icon" viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
    <path d={kPaths[name]} fill="none" stroke="currentColor" stroke-width="1.5" />
  </svg>
);
