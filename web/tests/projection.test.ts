import { describe, expect, test } from 'vitest';
import { turn, type Quaternion } from '../src/model/pose';
import {
  isSamePlace,
  projectionOf,
  projectionSpec,
  projectPicture,
  type FlatPicture,
} from '../src/model/projection';

const kNone: Quaternion = [1, 0, 0, 0];
/** A box of 4 x 2 x 1, away from the origin; the last vertex belongs to no triangle. */
const kBox = {
  positions: Float32Array.from([10, 0, 0, 14, 0, 0, 14, 2, 0, 10, 2, 1, 99, 99, 99]),
  indices: Uint32Array.from([0, 1, 2, 0, 2, 3]),
};

/** u, v of the first vertices, rounded. */
function uvsOf(picture: Partial<FlatPicture>, rotation = kNone): number[] {
  const uvs = new Float32Array((2 * kBox.positions.length) / 3);
  projectPicture(kBox, rotation, { kind: 'dip', turn_deg: 0, aspect: 1, ...picture }, uvs);
  return [...uvs.slice(0, 8)].map((value) => Math.round(1000 * value) / 1000);
}

describe('a picture projected from below', () => {
  test('has its right at -x, its up at y, and its middle in the middle of the box', () => {
    expect(uvsOf({})).toEqual([1, 0.25, 0, 0.25, 0, 0.75, 1, 0.75]);
  });

  test('covers the object: its shorter side is the longer side of the box', () => {
    expect(uvsOf({ aspect: 2 })).toEqual([0.75, 0.25, 0.25, 0.25, 0.25, 0.75, 0.75, 0.75]);
    expect(uvsOf({ aspect: 0.5 })).toEqual([1, 0.375, 0, 0.375, 0, 0.625, 1, 0.625]);
  });

  test('has the width that is given', () => {
    expect(uvsOf({ width: 8, aspect: 2 })).toEqual([
      0.75, 0.25, 0.25, 0.25, 0.25, 0.75, 0.75, 0.75,
    ]);
  });

  test('turns counter-clockwise', () => {
    // After a quarter turn, the picture's right is up, and its up is at the left.
    expect(uvsOf({ turn_deg: 90 }).slice(0, 2)).toEqual([0.25, 0]);
  });

  test('stays with the film if it is projected along the dip, otherwise with the object', () => {
    const rotation = turn('z', 90);
    expect(uvsOf({ kind: 'planar' }, rotation)).toEqual(uvsOf({}));
    // The first vertex is now at x and -y of the film: at the left and down, as seen from below.
    expect(uvsOf({}, rotation).slice(0, 2)).toEqual([0.25, 0]);
    expect(isSamePlace({ kind: 'planar', turn_deg: 0, aspect: 1 }, kNone, rotation)).toBe(true);
    expect(isSamePlace({ kind: 'dip', turn_deg: 0, aspect: 1 }, kNone, rotation)).toBe(false);
  });

  test('is finite for a single point', () => {
    const uvs = new Float32Array(2);
    const point = { positions: new Float32Array(3), indices: Uint32Array.of(0, 0, 0) };
    projectPicture(point, kNone, { kind: 'dip', turn_deg: 0, aspect: 1 }, uvs);
    expect([...uvs]).toEqual([0.5, 0.5]);
  });
});

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
