import { describe, expect, test } from 'vitest';
import { projectionOf, projectionSpec } from '../src/model/projection';

describe('the projection in a spec', () => {
  test('contains only what was chosen', () => {
    expect(projectionSpec({})).toEqual({});
    expect(projectionSpec({ kind: 'box', size_mm: 60, turn_deg: 90 })).toEqual({
      project: 'box',
      projectSizeMm: 60,
      projectTurnDeg: 90,
    });
  });

  test('is read back from a job', () => {
    const spec = { project: 'cylindrical', projectSizeMm: 60, projectTurnDeg: -5 };
    expect(projectionSpec(projectionOf(spec))).toEqual(spec);
  });
});
