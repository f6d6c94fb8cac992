/** Small pictures of the object in the pose of each dip, drawn by the 3D view once nothing changes any more. */
import { effect } from '@preact/signals';
import { dipsOf } from '../../model/dips';
import { draft } from './draft';
import { looks, view } from './mode';

const kPause_ms = 200;

/** Draws pictures that are missing or out of date, until the returned function is called. */
export function followThumbnails(canvases: () => Iterable<HTMLCanvasElement>): () => void {
  const drawn = new WeakMap<HTMLCanvasElement, string>();
  let timer = 0;
  const draw = () => {
    const poses = dipsOf(draft.value).map(({ pose }) => pose);
    const due = [...canvases()].flatMap((canvas, k) => {
      const pose = poses[k];
      const key = JSON.stringify([looks.value, pose]);
      if (!pose || drawn.get(canvas) === key) return [];
      drawn.set(canvas, key);
      return [{ canvas, pose }];
    });
    if (due.length > 0) view.value?.portray(due);
  };
  const end = effect(() => {
    void [draft.value, looks.value];
    window.clearTimeout(timer);
    if (view.value) timer = window.setTimeout(draw, kPause_ms);
  });
  return () => {
    end();
    window.clearTimeout(timer);
  };
}
