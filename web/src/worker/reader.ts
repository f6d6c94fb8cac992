/** The page's interface to mesh_worker. */
import { refused, type Result } from '../model/result';
import type { SurfaceMap } from '../model/surface_map';
import type { BoxLayer, FineMesh } from '../paint/axis_distance';

export type Question =
  | { what: 'surface_map'; bytes: ArrayBuffer }
  | {
      what: 'axis_distances';
      surface: { positions: Float32Array; indices: Uint32Array };
      boxes: (BoxLayer | undefined)[];
    };
export type Answer =
  | { what: 'surface_map'; result: Result<SurfaceMap> }
  | { what: 'axis_distances'; result: Result<FineMesh> };

let worker: Worker | undefined;
let count = 0;
const waiting = new Map<number, (answer: Answer | undefined) => void>();

function start(): Worker {
  const newWorker = new Worker(new URL('./mesh_worker.ts', import.meta.url), { type: 'module' });
  newWorker.onmessage = ({ data }: MessageEvent<{ id: number; answer: Answer }>) => {
    waiting.get(data.id)?.(data.answer);
    waiting.delete(data.id);
  };
  // The worker has most likely run out of memory. The next request starts a new worker.
  newWorker.onerror = () => {
    for (const give of waiting.values()) give(undefined);
    waiting.clear();
    newWorker.terminate();
    worker = undefined;
  };
  return newWorker;
}

function ask(question: Question): Promise<Answer | undefined> {
  worker ??= start();
  count += 1;
  const id = count;
  return new Promise((resolve) => {
    waiting.set(id, resolve);
    worker!.postMessage({ id, question }, 'bytes' in question ? [question.bytes] : []);
  });
}

const kTooMuch = refused(
  'this browser could not read the file',
  'The file may be too large. Try a desktop computer, or a model with fewer faces',
);

/** Reads a job's surface_map.ply. */
export async function readMap(bytes: ArrayBuffer): Promise<Result<SurfaceMap>> {
  const answer = await ask({ what: 'surface_map', bytes });
  return answer?.what === 'surface_map' ? answer.result : kTooMuch;
}

/** Subdivides a mesh (mm) for the 'box' layers of a paint; undefined if the browser has too little memory. */
export async function findDistances(
  surface: { positions: Float32Array; indices: Uint32Array },
  boxes: (BoxLayer | undefined)[],
): Promise<FineMesh | undefined> {
  const answer = await ask({ what: 'axis_distances', surface, boxes });
  return answer?.what === 'axis_distances' && answer.result.ok ? answer.result.value : undefined;
}
