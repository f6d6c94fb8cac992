import { useEffect, useRef, useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { inputOf } from '../../model/fields';
import { limitsOf } from '../../model/limits';
import { formatSize, kLengthUnits, likelyUnit, oddSize, unitOf } from '../../model/units';
import { Button, NumberField, Switch } from '../../ui/controls';
import { Icon } from '../../ui/icon';
import { WarningList } from '../../ui/warning';
import { orNotify } from '../../state/notices';
import { calibrated } from './calibration';
import { draft, longest_mm, rescale, shape, sides_mm, unitOfFormat } from './draft';
import { FileList, Waiting } from './file_list';
import {
  colourless,
  meshOf,
  notes,
  problems,
  reread,
  samples,
  take,
  takeSample,
  waiting,
} from './intake';
import { takeDropped } from './picture/dropped';
import { PicturePanel } from './picture/picture_panel';
import { stage } from './reading';
import { ReadingStatus } from './reading_status';

const kEndings = '.obj,.mtl,.bin,.ply,.stl,.glb,.gltf,.png,.jpg,.jpeg,.tif,.tiff,.toml';

function Browse({ label }: { label: string }) {
  const input = useRef<HTMLInputElement>(null);
  return (
    <>
      <input
        ref={input}
        type="file"
        multiple
        accept={kEndings}
        hidden
        onChange={(event) => {
          const { files } = event.currentTarget;
          if (files) void take([...files]);
          event.currentTarget.value = '';
        }}
      />
      <button type="button" onClick={() => input.current?.click()}>
        {label}
      </button>
    </>
  );
}

/** Accepts files dropped anywhere on the page; true while files are dragged over it. */
export function useDrop(): boolean {
  const [isOver, setOver] = useState(false);
  useEffect(() => {
    const over = (event: DragEvent) => {
      if (!event.dataTransfer?.types.includes('Files')) return;
      event.preventDefault();
      setOver(true);
    };
    const leave = (event: DragEvent) => {
      if (!event.relatedTarget) setOver(false);
    };
    const drop = (event: DragEvent) => {
      event.preventDefault();
      setOver(false);
      const files = event.dataTransfer?.files;
      if (files && files.length > 0) void takeDropped([...files], event.clientX, event.clientY);
    };
    window.addEventListener('dragover', over);
    window.addEventListener('dragleave', leave);
    window.addEventListener('drop', drop);
    return () => {
      window.removeEventListener('dragover', over);
      window.removeEventListener('dragleave', leave);
      window.removeEventListener('drop', drop);
    };
  }, []);
  return isOver;
}

/** The start of a new print: drop or choose a model. */
export function Intake({ isBusy }: { isBusy: boolean }) {
  const [ready, setReady] = useState<{ name: string; label: string }[]>([]);
  useEffect(() => void samples().then(setReady), []);
  return (
    <div class="intake">
      <h2>{isBusy ? 'Loading…' : 'Drop a model here'}</h2>
      <p>
        Supported models: OBJ (with its MTL), PLY, STL, glTF (with its BIN) and GLB. Add the texture
        image (PNG or JPEG) unless it is part of the model. You can also drop the image first.
      </p>
      <Waiting />
      <Browse label="Choose files" />
      {ready.length > 0 && (
        <p class="samples">
          Or try a sample:{' '}
          {ready.map(({ name, label }) => (
            <Button key={name} onPress={async () => orNotify(await takeSample(name))}>
              {label}
            </Button>
          ))}
        </p>
      )}
    </div>
  );
}

/** The accepted files, the size of the object, and the refused files. */
export function Taken() {
  const { files, from } = draft.value;
  const hasAny = files.length > 0 || from;
  return (
    <section aria-labelledby="object-title">
      <h2 id="object-title">1 Object</h2>
      {from && files.length === 0 && <p>Same object as in {from.job.replace('jobs/', 'job ')}</p>}
      {waiting.value.length === 0 && <FileList />}
      {shape.value && <ReadingStatus />}
      <Problems />
      <WarningList warnings={notes.value} />
      {!shape.value && !stage.value && meshOf(files) && (
        <button type="button" onClick={() => void reread()}>
          Read the model again
        </button>
      )}
      {hasAny && <Browse label="Add or replace files" />}
      {shape.value && !calibrated.value && <Size />}
      {shape.value && <PicturePanel />}
    </section>
  );
}

/** Refused and missing files. */
function Problems() {
  const all = [...problems.value, ...colourless.value];
  if (all.length === 0) return null;
  return (
    <div role="alert">
      <ul class="problems">
        {all.map(({ name, why }) => (
          <li key={name}>
            <Icon name="warning" />{' '}
            {!why.includes(name) && (
              <>
                <b>{name}</b>:{' '}
              </>
            )}
            {why}.
          </li>
        ))}
      </ul>
    </div>
  );
}

/** The unit of the model, and the size that follows from it. */
function Size() {
  const { scale } = draft.value;
  const unit = unitOf(scale);
  return (
    <>
      <div class="field">
        <span class="label" aria-hidden="true">
          Unit of the model{unit ? '' : ': custom'}
        </span>
        <Switch<string>
          label="Unit of the model"
          value={unit?.name ?? ''}
          choices={kLengthUnits.map(({ name }) => ({ value: name, label: name }))}
          onValue={(name) => rescale(kLengthUnits.find((one) => one.name === name)!.length_mm)}
        />
      </div>
      <p>
        Size: <b>{formatSize(sides_mm.value)}</b> <span class="quiet">(W × D × H)</span>
      </p>
      <SizeWarning />
      <div class="row">
        <NumberField
          label="Longest side"
          unit="mm"
          value={longest_mm.value}
          min={1}
          max={2000}
          onValue={(value) => rescale((scale * value) / longest_mm.value)}
        />
        <NumberField
          {...inputOf('scale')}
          {...limitsOf(rules.SimulateSpec.scale)}
          digits={6}
          value={scale}
          onValue={rescale}
        />
      </div>
    </>
  );
}

function SizeWarning() {
  const odd = oddSize(longest_mm.value);
  if (!odd) return null;
  const longest = longest_mm.value / draft.value.scale;
  const unit = likelyUnit(longest, unitOfFormat(`.${shape.value?.summary.format}`));
  return (
    <div class="warning" role="status">
      <p>
        The object is {odd === 'small' ? 'smaller than 5 mm' : 'larger than 1,000 mm'}.{' '}
        {unit
          ? `The unit of the model is probably ${unit.name}; its longest side is then ${formatSize([longest * unit.length_mm])}.`
          : 'Check the unit of the model, or enter its longest side.'}
      </p>
      {unit && (
        <button type="button" onClick={() => rescale(unit.length_mm)}>
          Use {unit.name}
        </button>
      )}
    </div>
  );
}
