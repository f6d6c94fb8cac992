/** Models as the engine returns them, for tests. */
import type { Box } from '../src/model/mesh';
import type { Summary } from '../src/model/summary';
import type { Shape } from '../src/screens/new_print/draft';

export const summaryOf = (more: Partial<Summary> = {}): Summary => ({
  format: 'OBJ',
  scale: 1,
  lowest_mm: [0, 0, 0],
  highest_mm: [9, 9, 0],
  triangles: 1,
  shown_triangles: 1,
  ...more,
});

/** A triangle. */
export const shapeOf = (
  summary: Partial<Summary> = {},
  box: Box = { min: [0, 0, 0], max: [9, 9, 0] },
): Shape => {
  const positions = Float32Array.of(0, 0, 0, 9, 0, 0, 0, 9, 0);
  const indices = Uint32Array.of(0, 1, 2);
  return {
    mesh: { positions, indices, parts: [{ look: { colour: [1, 1, 1] }, first: 0, count: 3 }] },
    box,
    places: { positions, corners: indices },
    summary: summaryOf(summary),
    source: { mesh: { name: 'x.obj', asset: 'assets/1' }, extraFiles: [] },
  };
};
