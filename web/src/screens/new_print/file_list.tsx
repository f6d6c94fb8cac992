/** The files of the draft, and those that wait for a model. */
import { useEffect, useRef } from 'preact/hooks';
import { formatBytes } from '../../model/units';
import { arrangement, remove, waiting } from './intake';
import { draft } from './draft';

export function FileList() {
  const { files } = draft.value;
  if (files.length === 0) return null;
  const rest = files.slice(kMostShown);
  return (
    <>
      <List files={files.slice(0, kMostShown)} />
      {rest.length > 0 && (
        <details>
          <summary>{rest.length} more files</summary>
          <List files={rest} />
        </details>
      )}
    </>
  );
}

const kMostShown = 8;

function List({ files }: { files: readonly File[] }) {
  const { texture, unused } = arrangement.value;
  return (
    <ul class="files">
      {files.map((file) => (
        <li key={file.name}>
          <span class="name">{file.name}</span>
          <span class="quiet">
            {unused.includes(file) ? 'not used' : formatBytes(file.size)}
            {(file === texture || unused.includes(file)) && <Remove file={file} />}
          </span>
        </li>
      ))}
    </ul>
  );
}

/** Files that were dropped before their model. */
export function Waiting() {
  if (waiting.value.length === 0) return null;
  return (
    <ul class="files waiting" aria-live="polite">
      {waiting.value.map((file) => (
        <li key={file.name}>
          <Thumbnail file={file} />
          <span class="name">{file.name} waits for a model</span>
          <Remove file={file} />
        </li>
      ))}
    </ul>
  );
}

const Remove = ({ file }: { file: File }) => (
  <button
    type="button"
    class="plain"
    aria-label={`Remove ${file.name}`}
    onClick={() => void remove(file)}
  >
    Remove
  </button>
);

const kThumbnailHeight_px = 96;

/** A small picture of the file; nothing if the browser cannot show it (TIFF, MTL). */
function Thumbnail({ file }: { file: File }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    let isGone = false;
    const draw = (picture: ImageBitmap) => {
      const element = canvas.current;
      if (isGone || !element) return;
      Object.assign(element, { width: picture.width, height: picture.height, hidden: false });
      element.getContext('2d')!.drawImage(picture, 0, 0);
    };
    createImageBitmap(file, { resizeHeight: kThumbnailHeight_px }).then(draw, () => {});
    return () => {
      isGone = true;
    };
  }, [file]);
  return <canvas ref={canvas} hidden aria-hidden="true" />;
}
