import { artifactAddress } from '../../api/services';
import type { Artifact } from '../../api/types';
import { formatBytes } from '../../model/units';
import { fileOf, type Results } from './results';

const kWhat: Record<string, string> = {
  'film.png': 'Film image; print it at its original size',
  'film_map.exr': 'Map from the film to the object',
  'surface_map.ply': 'Map from the object to the film',
  'stretch.png': 'Stretch of the film on the object',
  'wrinkles.png': 'Wrinkles of the film',
  'predicted.png': 'Predicted appearance of the object',
  'report.json': 'Options, figures and warnings',
  'report.html': 'Report with pictures',
  'print.pdf': 'Pages to print, at exact scale',
  'print.png': 'Pages as an image',
  'print.tif': 'Pages as a CMYK image',
  'placement.pdf': 'Template for placing the object',
  'positions.csv': 'Axis position over time',
  'pose.json': 'Pose of the object',
  'calibration.json': 'Calibration with its covariance',
  'camera.json': 'Lens and depth scale of the camera',
  'alignment.png': 'The scan aligned with the object',
  'error.png': 'Estimated error on the surface',
  'film_profile.toml': 'The fitted film profile',
  'combined.png': 'Predicted appearance of the object after all dips',
  'plan.json': 'The plan: film, poses and depths of the dips',
  'plan.ply': 'Dip, weights and stretch at each point of the object',
};

const kWhatOfDip: Record<string, string> = {
  film: 'film image; print it at its original size',
  complete: 'film image if this dip printed everything that it reaches',
  mask: 'share of the picture that this dip prints',
  stretch: 'stretch of the film on the object',
};

/** Describes a file; undefined if there is no text for it. */
function whatIs(name: string): string | undefined {
  const [, kind = '', dip] = /^([a-z]+)-(\d+)\.png$/.exec(name) ?? [];
  return kWhatOfDip[kind] ? `Dip ${dip}: ${kWhatOfDip[kind]}` : kWhat[name];
}

/** All artifacts of the job, to download. */
export function Files({ results }: { results: Results }) {
  const artifacts = results.artifacts.value;
  if (!artifacts) return <p class="quiet">Loading…</p>;
  if (artifacts.length === 0) return <p class="quiet">This job has no files.</p>;
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
        {whatIs(name) ? ` · ${whatIs(name)}` : ''}
      </span>
    </li>
  );
}

/** A plan of twelve dips has 49. */
const kMostPictures = 50;

/** Artifacts that are images which browsers can display. */
export function Pictures({ results, only }: { results: Results; only?: readonly string[] }) {
  const pictures = (results.artifacts.value ?? []).filter(
    (artifact) =>
      artifact.mediaType.startsWith('image/') &&
      /\.(png|jpe?g)$/i.test(artifact.name) &&
      (!only || only.includes(fileOf(artifact))),
  );
  return (
    <div class="pictures">
      {pictures.slice(0, kMostPictures).map((artifact) => {
        const name = fileOf(artifact);
        return (
          <figure key={name}>
            <a href={artifactAddress(results.job, name, true)}>
              <img
                src={artifactAddress(results.job, name, true)}
                alt={whatIs(name) ?? name}
                loading="lazy"
              />
            </a>
            <figcaption>{whatIs(name) ?? name}</figcaption>
          </figure>
        );
      })}
    </div>
  );
}
