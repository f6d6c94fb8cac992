/** Models as the engine returns them, for tests. */
import type { ModelSummary } from '../src/api/types';
import type { Box } from '../src/model/mesh';
import type { Shape } from '../src/screens/new_print/draft';

export const summaryOf = (more: Partial<ModelSummary> = {}): ModelSummary => ({
  format: 'OBJ',
  scale: 1,
  vertices: 3,
  triangles: 1,
  lowestMm: [0, 0, 0],
  highestMm: [9, 9, 0],
  hasTextureCoordinates: false,
  hasColour: false,
  materials: [],
  notUnderstood: [],
  shownTriangles: 1,
  warnings: [],
  companions: [],
  ...more,
});

/** A triangle. */
export const shapeOf = (
  summary: Partial<ModelSummary> = {},
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
