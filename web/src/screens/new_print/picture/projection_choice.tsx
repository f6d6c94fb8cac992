/** The choice of the projection from small drawings. */
import { useId } from 'preact/hooks';
import type { ProjectionName } from '../../../paint/layer';
import { Pictogram } from './pictograms';

type Projection = Exclude<ProjectionName, 'vertex_colors'>;

const kChoices: { value: Projection; label: string; how: string }[] = [
  {
    value: 'uv',
    label: 'Coordinates',
    how: 'The texture coordinates of the model place the picture.',
  },
  {
    value: 'dip',
    label: 'From below',
    how: 'The picture is projected from below, as the film sees the object.',
  },
  {
    value: 'planar',
    label: 'From one side',
    how: 'The picture is projected from one side, through the whole object.',
  },
  { value: 'cylindrical', label: 'Around', how: 'The picture goes around the object.' },
  {
    value: 'box',
    label: 'Three sides',
    how: 'The picture is projected from three sides and blended where they meet.',
  },
  { value: 'decal', label: 'Sticker', how: 'The picture sticks to one place on the surface.' },
];

/** What a projection does, in one sentence. */
export const howOf = (projection: ProjectionName): string =>
  kChoices.find(({ value }) => value === projection)?.how ?? '';

export function ProjectionChoice(props: {
  value: ProjectionName;
  lacksCoordinates: boolean;
  onValue: (projection: ProjectionName) => void;
}) {
  const name = useId();
  const choices = kChoices.filter(({ value }) => value !== 'uv' || !props.lacksCoordinates);
  return (
    <fieldset class="drawings">
      <legend>How the picture comes to the surface</legend>
      {choices.map(({ value, label }) => (
        <label key={value}>
          <input
            type="radio"
            name={name}
            checked={value === props.value}
            onChange={() => props.onValue(value)}
          />
          <span>
            <Pictogram projection={value} />
            {label}
          </span>
        </label>
      ))}
    </fieldset>
  );
}
