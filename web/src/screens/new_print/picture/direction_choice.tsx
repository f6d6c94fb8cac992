/** The direction from which the picture comes, or the axis around which it goes. */
import { Switch } from '../../../ui/controls';
import { layer } from '../draft';
import {
  around,
  axisOf,
  kAxes,
  kSides,
  lookFrom,
  sideOf,
  type Axis,
  type Side,
} from './directions';
import { choose, rotation } from './placed';

const kAxisLabels: Record<Axis, string> = {
  upright: 'Upright',
  sideways: 'Left to right',
  forward: 'Front to back',
};

const capitalized = (text: string) => text[0]!.toUpperCase() + text.slice(1);

const Labelled = <T extends string>(props: {
  label: string;
  value: T | undefined;
  choices: { value: T; label: string }[];
  onValue: (value: T) => void;
}) => (
  <div class="field">
    <span class="label" aria-hidden="true">
      {props.label}
    </span>
    <Switch<T | ''>
      {...props}
      value={props.value ?? ''}
      onValue={(value) => value && props.onValue(value)}
    />
  </div>
);

/** Directions as in the view, for the object as it is turned now. */
const Direction = () => (
  <Labelled<Side>
    label="Seen from"
    value={sideOf(layer.value.direction, rotation.value)}
    choices={kSides.map((value) => ({ value, label: capitalized(value) }))}
    onValue={(side) => choose({ up: undefined, ...lookFrom(side, rotation.value) })}
  />
);

const AxisChoice = () => (
  <Labelled<Axis>
    label="Axis"
    value={axisOf(layer.value, rotation.value)}
    choices={kAxes.map((value) => ({ value, label: kAxisLabels[value] }))}
    onValue={(axis) =>
      choose({ up: undefined, direction: undefined, ...around(axis, rotation.value) })
    }
  />
);

export function DirectionChoice() {
  const { projection } = layer.value;
  if (projection === 'planar' || projection === 'decal') return <Direction />;
  return projection === 'cylindrical' ? <AxisChoice /> : null;
}
