import * as rules from '../../api/rules';
import { inputOf } from '../../model/fields';
import { filmOf, kFilmChoices } from '../../model/film';
import { limitsOf } from '../../model/limits';
import { Choice, NumberField, TextField } from '../../ui/controls';
import { useRefusal } from '../../ui/field_errors';
import { calibrated } from './calibration';
import { change, draft, film, selectedDip, shape } from './draft';

const kOwn = 'own';

/** Settings of the film and the printer. */
export function FilmPanel() {
  if (!shape.value) return null;
  const { dpi, paper, colours } = draft.value;
  return (
    <section aria-labelledby="film-title">
      <h2 id="film-title">3 Film and printer</h2>
      {!calibrated.value && <FilmChoice />}
      <div class="row">
        <Choice
          {...inputOf('dpi')}
          value={String(dpi)}
          onValue={(value) => change({ dpi: Number(value) })}
          choices={[...new Set([150, 300, 600, 1200, dpi])].map((value) => ({
            value: String(value),
            label: `${value} dpi`,
          }))}
        />
        <Choice
          {...inputOf('paper')}
          value={paper}
          onValue={(value) => change({ paper: value })}
          choices={['A4', 'A3', 'letter'].map((value) => ({ value, label: value }))}
        />
        <Choice
          {...inputOf('colours')}
          value={colours}
          onValue={(value) => change({ colours: value })}
          choices={[
            { value: 'COLOURS_RGB', label: 'RGB (most printers)' },
            { value: 'COLOURS_CMYK', label: 'CMYK' },
          ]}
        />
      </div>
    </section>
  );
}

function FilmChoice() {
  const name = draft.value.film;
  const isListed = kFilmChoices.some((one) => one.name === name);
  const { width_mm, height_mm } = film.value;
  // Other custom sizes do not change the value of the choice.
  useRefusal({ name: 'film' }, name);
  const setSize = (width: number, height: number) => {
    const made = `${width}x${height}`;
    if (filmOf(made)) change({ film: made });
  };
  return (
    <>
      <Choice
        {...inputOf('film')}
        value={isListed ? name : kOwn}
        onValue={(value) =>
          value === kOwn ? setSize(width_mm + 0.1, height_mm) : change({ film: value })
        }
        choices={[
          ...kFilmChoices.map((one) => ({ value: one.name, label: one.label })),
          { value: kOwn, label: 'Custom size' },
        ]}
      />
      {!isListed && (
        <div class="row">
          <NumberField
            label="Film width"
            unit="mm"
            value={width_mm}
            min={10}
            max={2000}
            onValue={(mm) => setSize(mm, height_mm)}
          />
          <NumberField
            label="Film height"
            unit="mm"
            value={height_mm}
            min={10}
            max={2000}
            onValue={(mm) => setSize(width_mm, mm)}
          />
        </div>
      )}
    </>
  );
}

/** Settings whose defaults are usually right. */
export function MorePanel() {
  if (!shape.value) return null;
  const { model, speed_mm_per_s, depth_mm, name } = draft.value;
  const dip = selectedDip();
  return (
    <details>
      <summary>More settings</summary>
      <TextField
        label="Job name"
        value={name}
        maxBytes={rules.Job.displayName.maxBytes}
        onValue={(value) => change({ name: value })}
      />
      <div class="row">
        <NumberField
          key={dip}
          {...inputOf('depthMm', dip)}
          {...limitsOf(rules.SimulateSpec.depthMm)}
          placeholder="whole object"
          value={depth_mm}
          digits={3}
          onValue={(value) => change({ depth_mm: value })}
          onEmpty={() => change({ depth_mm: undefined })}
        />
        <NumberField
          {...inputOf('dipSpeedMmPerS')}
          {...limitsOf(rules.SimulateSpec.dipSpeedMmPerS)}
          value={speed_mm_per_s}
          digits={3}
          onValue={(value) => change({ speed_mm_per_s: value })}
        />
      </div>
      <Choice
        {...inputOf('model')}
        value={model}
        onValue={(value) => change({ model: value })}
        choices={[
          { value: 'MODEL_SHEET', label: 'Viscous sheet with ink (exact)' },
          { value: 'MODEL_STOKES', label: 'Stokes flow (fast; for stretch below 1.3×)' },
        ]}
      />
      <p class="quiet">To use a film profile, drop its TOML file on this page.</p>
    </details>
  );
}
