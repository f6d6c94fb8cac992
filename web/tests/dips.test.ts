import { expect, test } from 'vitest';
import {
  add,
  dipsOf,
  kMostDips,
  move,
  remove,
  select,
  split,
  type Dip,
  type Dips,
} from '../src/model/dips';
import { kUpright, rotate } from '../src/model/pose';

const at = (x_mm: number, depth_mm?: number): Dip => ({
  pose: { ...kUpright, centre_mm: [x_mm, 0] },
  depth_mm,
});
const three = split([at(1), at(2, 20), at(3, 30)], 1);
const places = (dips: Dips) => dipsOf(dips).map(({ pose }) => pose.centre_mm[0]);
const selected = ({ before }: Dips) => before.length;

test('another dip is the last one, is selected, and has the object upside down at the same place and depth', () => {
  const dips = add(split([at(5, 7), at(6)], 0));
  expect(places(dips)).toEqual([5, 6, 5]);
  expect(selected(dips)).toBe(2);
  expect(dipsOf(dips).slice(0, 2)).toEqual([at(5, 7), at(6)]);
  expect(dips.depth_mm).toBe(7);
  expect(rotate(dips.pose.rotation, [0, 0, 1])[2]).toBeCloseTo(-1);
});

test('there are at most as many dips as a plan may have', () => {
  let dips = split([at(0)], 0);
  for (let i = 0; i < 20; i += 1) dips = add(dips);
  expect(dipsOf(dips).length).toBe(kMostDips);
});

test('a dip is selected without a change of any dip', () => {
  for (const k of [0, 1, 2]) {
    const dips = select(three, k);
    expect(dipsOf(dips)).toEqual([at(1), at(2, 20), at(3, 30)]);
    expect(dips).toMatchObject(dipsOf(three)[k]!);
  }
});

test('a dip of the whole object does not take the depth of the dip before', () => {
  expect({ ...three, ...select(three, 0) }.depth_mm).toBeUndefined();
});

test('after a removal, the same dip is selected, or its successor, or the last one', () => {
  expect(remove(three, 0)).toEqual(split([at(2, 20), at(3, 30)], 0));
  expect(remove(three, 2)).toEqual(split([at(1), at(2, 20)], 1));
  expect(remove(three, 1)).toEqual(split([at(1), at(3, 30)], 1));
  expect(remove(select(three, 2), 2)).toEqual(split([at(1), at(2, 20)], 1));
});

test('the only dip stays', () => {
  const one = split([at(1)], 0);
  expect(remove(one, 0)).toEqual(one);
});

test('a dip is moved with its depth, and the selected dip stays selected', () => {
  for (const k of [0, 1, 2]) {
    const dips = move(select(three, k), 0, 2);
    expect(dipsOf(dips)).toEqual([at(2, 20), at(3, 30), at(1)]);
    expect(dips.pose).toEqual(at(k + 1).pose);
  }
  expect(places(move(three, 2, 1))).toEqual([1, 3, 2]);
  expect(selected(move(three, 2, 1))).toBe(2);
});

test('nothing is moved beyond the first or the last place', () => {
  expect(move(three, 0, -1)).toBe(three);
  expect(move(three, 2, 3)).toBe(three);
});
