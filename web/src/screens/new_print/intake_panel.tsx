import { useEffect, useRef, useState } from 'preact/hooks';
import * as rules from '../../api/rules';
import { limitsOf } from '../../model/limits';
import { formatBytes, formatMm } from '../../model/units';
import { Button, NumberField } from '../../ui/controls';
import { Icon } from '../../ui/icon';
import { orNotify } from '../../state/notices';
import { calibrated } from './calibration';
import { change, draft, longest_mm, shape } from './draft';
import { isReading, problems, samples, take, takeSample } from './intake';

const kEndings = '.obj,.mtl,.ply,.stl,.glb,.gltf,.png,.jpg,.jpeg,.tif,.tiff,.toml';

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
      if (files && files.length > 0) void take([...files]);
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
        Supported models: OBJ (with its MTL), PLY, STL, glTF and GLB. Add the texture image (PNG or
        JPEG) unless it is part of the model.
      </p>
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
  const { files, from, scale } = draft.value;
  const hasAny = files.length > 0 || from;
  const unit_mm = shape.value?.mesh.unit_mm ?? 1;
  return (
    <section aria-labelledby="object-title">
      <h2 id="object-title">1 Object</h2>
      {from && files.length === 0 && <p>Same object as in {from.job.replace('jobs/', 'job ')}</p>}
      {files.length > 0 && (
        <ul class="files">
          {files.map((file) => (
            <li key={file.name}>
              <span class="name">{file.name}</span>
              <span class="quiet">{formatBytes(file.size)}</span>
            </li>
          ))}
        </ul>
      )}
      {isReading.value && <p role="status">Reading the model…</p>}
      {problems.value.length > 0 && (
        <div role="alert">
          <ul class="problems">
            {problems.value.map(({ name, why }) => (
              <li key={name}>
                <Icon name="warning" /> <b>{name}</b>: {why}.
              </li>
            ))}
          </ul>
        </div>
      )}
      {hasAny && <Browse label="Add or replace files" />}
      {shape.value && !calibrated.value && (
        <div class="row">
          <NumberField
            label="Longest side"
            unit="mm"
            value={longest_mm.value}
            min={1}
            max={2000}
            onValue={(value) => change({ scale: (scale * value) / longest_mm.value })}
          />
          <NumberField
            label="One unit is"
            {...limitsOf(rules.SimulateSpec.scale)}
            digits={6}
            value={scale}
            onValue={(value) => change({ scale: value })}
          />
        </div>
      )}
      {shape.value && scale !== unit_mm && files.length > 0 && !calibrated.value && (
        <p class="quiet">
          Without scaling, the longest side would be{' '}
          {formatMm((longest_mm.value / scale) * unit_mm)}. Check the size of the object.
        </p>
      )}
    </section>
  );
}
