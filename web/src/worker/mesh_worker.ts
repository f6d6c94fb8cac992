/** Reads models and surface maps, and prepares paints, in a separate thread, so that the page stays responsive. */
import { readGltf } from '../model/gltf';
import { boxOf, type Mesh } from '../model/mesh';
import { decodeText } from '../model/mtl';
import { readObj } from '../model/obj';
import { readPlyMesh } from '../model/ply_mesh';
import { attempt } from '../model/result';
import { readStl } from '../model/stl';
import { readSurfaceMap } from '../model/surface_map';
import { axisDistances } from '../paint/axis_distance';
import type { Answer, Question } from './reader';

const readObjBytes = (bytes: ArrayBuffer): Mesh => readObj(decodeText(bytes));
const kReaders: Record<string, (bytes: ArrayBuffer) => Mesh> = {
  stl: readStl,
  ply: readPlyMesh,
  glb: readGltf,
  gltf: readGltf,
};

function read(question: Question): Answer {
  if (question.what === 'axis_distances') {
    const { surface, boxes } = question;
    return { what: 'axis_distances', result: attempt(() => axisDistances(surface, boxes)) };
  }
  const { bytes } = question;
  if (question.what === 'surface_map')
    return { what: 'surface_map', result: attempt(() => readSurfaceMap(bytes)) };
  const result = attempt(() => {
    const ending = question.name.toLowerCase().split('.').at(-1);
    const mesh = (kReaders[ending ?? ''] ?? readObjBytes)(bytes);
    return { mesh, box: boxOf(mesh) };
  });
  return { what: 'mesh', result };
}

self.onmessage = ({ data }: MessageEvent<{ id: number; question: Question }>) => {
  self.postMessage({ id: data.id, answer: read(data.question) });
};
