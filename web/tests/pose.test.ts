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
  test('turned by 90° about z takes x to y', () => {
    close(rotate(turn('z', 90), [1, 0, 0]), [0, 1, 0]);
    close(rotate(turn('x', 90), [0, 1, 0]), [0, 0, 1]);
    close(rotate(turn('y', 90), [0, 0, 1]), [1, 0, 0]);
  });

  test('that is a product applies the right factor first', () => {
    const both = product(turn('z', 90), turn('x', 90));
    close(rotate(both, [0, 1, 0]), rotate(turn('z', 90), rotate(turn('x', 90), [0, 1, 0])));
  });

  test.each<Vec3>([
    [0, 0, 0],
    [10, 20, 30],
    [-170, 80, 120],
    [45, -89, -45],
  ])('keeps the angles %j when converted there and back', (...angles) => {
    close(toAngles(fromAngles(angles)), angles);
  });

  test('in gimbal lock gets other angles but the same rotation', () => {
    const q = fromAngles([30, 90, 50]);
    const v: Vec3 = [1, 2, 3];
    const again = rotate(fromAngles(toAngles(q)), v);
    rotate(q, v).forEach((value, i) => expect(again[i]).toBeCloseTo(value, 6));
  });

  test("for the API puts the centre of the object's box at the given position", () => {
    const box: Vec3 = [3, -4, 60];
    const pose = { rotation: fromAngles([20, 30, 40]), centre_mm: [12, -7] as const };
    const { rotationWxyz, translationMm } = toApi(pose, box);
    const [x, y] = rotate(pose.rotation, box);
    close([x + translationMm[0]!, y + translationMm[1]!], [12, -7]);
    close(rotationWxyz, pose.rotation);
    close(fromApi({ rotationWxyz, translationMm }, box)!.centre_mm, [12, -7]);
  });

  test('with missing numbers is undefined', () => {
    expect(fromApi(undefined, [0, 0, 0])).toBeUndefined();
    expect(
      fromApi({ rotationWxyz: [1, 0, 0], translationMm: [0, 0, 0] }, [0, 0, 0]),
    ).toBeUndefined();
    expect(fromApi({ rotationWxyz: [1, 0, 0, 0], translationMm: [] }, [0, 0, 0])).toBeUndefined();
  });
});
