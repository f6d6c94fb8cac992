import { artifactAddress } from '../../api/services';
import type { Artifact } from '../../api/types';
import { formatBytes } from '../../model/units';
import { fileOf, type Results } from './results';

const kWhat: Record<string, string> = {
  'film.png': 'The image to print, at its own size',
  'film_map.exr': 'Where each point of the film lands',
  'surface_map.ply': 'Where each point of the object takes its film from',
  'stretch.png': 'The stretch on the object',
  'wrinkles.png': 'How far the film is gathered',
  'predicted.png': 'The object as it will look',
  'report.json': 'Figures, warnings, inputs',
  'report.html': 'Report with pictures',
  'print.pdf': 'The pages to print, at exact scale',
  'print.png': 'The pages as a picture',
  'print.tif': 'The pages as a picture, CMYK',
  'placement.pdf': 'Where the object belongs',
  'positions.csv': 'Where the axis was, over time',
  'pose.json': 'Where the object hangs',
  'calibration.json': 'The calibration, with its covariance',
  'camera.json': "The camera's lens and depth scale",
  'alignment.png': 'The scan over the object',
  'error.png': 'How far off the surface may be',
  'film_profile.toml': 'The film profile that was found',
};

/** Everything the job left, to download. */
export function Files({ results }: { results: Results }) {
  const artifacts = results.artifacts.value;
  if (!artifacts) return <p class="quiet">Asking…</p>;
  if (artifacts.length === 0) return <p class="quiet">This job left no files.</p>;
  return (
    <ul class="files">
      {artifacts.map((artifact) => (
        <File key={artifact.name} job={results.job} artifact={artifact} />
      ))}
    </ul>
  );
}

function File({ job, artifact }: { job: string; artifact: Artifact }) {
  const name = fileOf(artifact);
  return (
    <li>
      <a href={artifactAddress(job, name)} download={name}>
        {name}
      </a>
      <span class="quiet">
        {formatBytes(Number(artifact.sizeBytes))}
        {kWhat[name] ? ` · ${kWhat[name]}` : ''}
      </span>
    </li>
  );
}

/** The pictures that a browser shows by itself. */
export function Pictures({ results, only }: { results: Results; only?: readonly string[] }) {
  const pictures = (results.artifacts.value ?? []).filter(
    (artifact) =>
      artifact.mediaType.startsWith('image/') &&
      /\.(png|jpe?g)$/i.test(artifact.name) &&
      (!only || only.includes(fileOf(artifact))),
  );
  return (
    <div class="pictures">
      {pictures.slice(0, 12).map((artifact) => {
        const name = fileOf(artifact);
        return (
          <figure key={name}>
            <a href={artifactAddress(results.job, name, true)}>
              <img
                src={artifactAddress(results.job, name, true)}
                alt={kWhat[name] ?? name}
                loading="lazy"
              />
            </a>
            <figcaption>{kWhat[name] ?? name}</figcaption>
          </figure>
        );
      })}
    </div>
  );
}
