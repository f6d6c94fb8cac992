/** Reads surface maps and prepares paints in a separate thread, so that the page stays responsive. */
import { attempt } from '../model/result';
import { readSurfaceMap } from '../model/surface_map';
import { axisDistances } from '../paint/axis_distance';
import type { Answer, Question } from './reader';

function read(question: Question): Answer {
  if (question.what === 'axis_distances') {
    const { surface, boxes } = question;
    return { what: 'axis_distances', result: attempt(() => axisDistances(surface, boxes)) };
  }
  return { what: 'surface_map', result: attempt(() => readSurfaceMap(question.bytes)) };
}

self.onmessage = ({ data }: MessageEvent<{ id: number; question: Question }>) => {
  self.postMessage({ id: data.id, answer: read(data.question) });
};
