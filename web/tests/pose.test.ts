import { describe, expect, test } from 'vitest';
import {
  fromAngles,
  fromApi,
  product,
  rotate,
  toAngles,
  toApi,
  turn,
  type Vec3,
} from '../src/model/pose';

const close = (a: readonly number[], b: readonly number[]) =>
  a.forEach((value, i) => expect(value).toBeCloseTo(b[i]!, 9));

describe('a pose', () => {
  test('turns x to y by a quarter turn about z', () => {
    close(rotate(turn('z', 90), [1, 0, 0]), [0, 1, 0]);
    close(rotate(turn('x', 90), [0, 1, 0]), [0, 0, 1]);
    close(rotate(turn('y', 90), [0, 0, 1]), [1, 0, 0]);
  });

  test('of two turns does the right one first', () => {
    const both = product(turn('z', 90), turn('x', 90));
    close(rotate(both, [0, 1, 0]), rotate(turn('z', 90), rotate(turn('x', 90), [0, 1, 0])));
  });

  test.each<Vec3>([
    [0, 0, 0],
    [10, 20, 30],
    [-170, 80, 120],
    [45, -89, -45],
  ])('is the same by angles %j and back', (...angles) => {
    close(toAngles(fromAngles(angles)), angles);
  });

  test('at the pole has other angles, but the same turn', () => {
    const q = fromAngles([30, 90, 50]);
    const v: Vec3 = [1, 2, 3];
    const again = rotate(fromAngles(toAngles(q)), v);
    rotate(q, v).forEach((value, i) => expect(again[i]).toBeCloseTo(value, 6));
  });

  test("puts the centre of the object's box where it was told, for the API", () => {
    const box: Vec3 = [3, -4, 60];
    const pose = { rotation: fromAngles([20, 30, 40]), centre_mm: [12, -7] as const };
    const { rotationWxyz, translationMm } = toApi(pose, box);
    const [x, y] = rotate(pose.rotation, box);
    close([x + translationMm[0]!, y + translationMm[1]!], [12, -7]);
    close(rotationWxyz, pose.rotation);
    close(fromApi({ rotationWxyz, translationMm }, box)!.centre_mm, [12, -7]);
  });

  test('that lacks numbers is none', () => {
    expect(fromApi(undefined, [0, 0, 0])).toBeUndefined();
    expect(
      fromApi({ rotationWxyz: [1, 0, 0], translationMm: [0, 0, 0] }, [0, 0, 0]),
    ).toBeUndefined();
    expect(fromApi({ rotationWxyz: [1, 0, 0, 0], translationMm: [] }, [0, 0, 0])).toBeUndefined();
  });
});
