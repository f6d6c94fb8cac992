import { expect, test } from 'vitest';
import { add, kMostDips, posesOf, remove, select, type Dips } from '../src/model/dips';
import { kUpright, rotate, type Pose } from '../src/model/pose';

const at = (x_mm: number): Pose => ({ ...kUpright, centre_mm: [x_mm, 0] });
const three: Dips = { before: [at(1)], pose: at(2), after: [at(3)] };
const places = (dips: Dips) => posesOf(dips).map(({ centre_mm: [x] }) => x);
const selected = ({ before }: Dips) => before.length;

test('another dip is the last one, is selected, and has the object upside down at the same place', () => {
  const dips = add({ before: [], pose: at(5), after: [at(6)] });
  expect(places(dips)).toEqual([5, 6, 5]);
  expect(selected(dips)).toBe(2);
  expect(posesOf(dips)[0]).toEqual(at(5));
  expect(rotate(dips.pose.rotation, [0, 0, 1])[2]).toBeCloseTo(-1);
});

test('there are at most as many dips as a plan may have', () => {
  let dips: Dips = { before: [], pose: kUpright, after: [] };
  for (let i = 0; i < 20; i += 1) dips = add(dips);
  expect(posesOf(dips).length).toBe(kMostDips);
});

test('a dip is selected without a change of any pose', () => {
  for (const k of [0, 1, 2]) {
    const dips = select(three, k);
    expect(places(dips)).toEqual([1, 2, 3]);
    expect(dips.pose).toEqual(at(k + 1));
  }
});

test('after a removal, the same dip is selected, or its successor, or the last one', () => {
  expect(remove(three, 0)).toEqual({ before: [], pose: at(2), after: [at(3)] });
  expect(remove(three, 2)).toEqual({ before: [at(1)], pose: at(2), after: [] });
  expect(remove(three, 1)).toEqual({ before: [at(1)], pose: at(3), after: [] });
  expect(remove(select(three, 2), 2)).toEqual({ before: [at(1)], pose: at(2), after: [] });
});

test('the only dip stays', () => {
  const one: Dips = { before: [], pose: at(1), after: [] };
  expect(remove(one, 0)).toEqual(one);
});
