import { describe, expect, test } from 'vitest';
import { rotate, turn, type Quaternion, type Vec3 } from '../src/model/pose';
import type { PaintLayer } from '../src/paint/layer';
import { place } from '../src/paint/placement';
import { decalAt, landing } from '../src/screens/new_print/picture/drop';
import { PictureGestures } from '../src/screens/new_print/picture/gestures';
import {
  moved,
  roundedTurn,
  scaled,
  turned,
  twisted,
  type Grip,
} from '../src/screens/new_print/picture/move';
import { dot, minus } from '../src/screens/new_print/picture/vectors';
import type { SurfacePoint } from '../src/view3d/pose_view';

const kNone: Quaternion = [1, 0, 0, 0];

/** A cube with sides of 20 mm about the origin. */
const kCube = {
  positions: Float32Array.from(
    [-10, 10].flatMap((x) => [-10, 10].flatMap((y) => [-10, 10].flatMap((z) => [x, y, z]))),
  ),
  indices: Uint32Array.from([0, 1, 2, 3, 4, 5, 6, 7, 0]),
};

const placed = (layer: PaintLayer, rotation_FO = kNone) => ({
  layer,
  placement: place(layer, kCube, rotation_FO, 2),
  rotation_FO,
});
const point = (point_mm: Vec3, normal: Vec3): SurfacePoint => ({ point_mm, normal });
const grip = (layer: PaintLayer, at: SurfacePoint, rotation_FO = kNone): Grip => ({
  ...placed(layer, rotation_FO),
  at,
});

/** s, t of a point on the picture, before the turn; see PaintLayer in spec.proto. */
function onPicture(layer: PaintLayer, p: Vec3, rotation_FO = kNone): [number, number] {
  const { placement } = placed(layer, rotation_FO);
  const q = minus(p, placement.position_mm);
  if (layer.projection !== 'cylindrical') return [dot(q, placement.right), dot(q, placement.up)];
  const angle = Math.atan2(dot(q, placement.right), -dot(q, placement.direction));
  return [angle - placement.turn_rad, dot(q, placement.up)];
}

/** Expects that the touched point of the picture is where the pointer is. */
function expectUnderPointer(held: Grip, to: SurfacePoint, digits = 1): void {
  const after = { ...held.layer, ...moved(held, to) };
  const before = onPicture(held.layer, held.at.point_mm, held.rotation_FO);
  const now = onPicture(after, to.point_mm, held.rotation_FO);
  expect(now[0]).toBeCloseTo(before[0], digits);
  expect(now[1]).toBeCloseTo(before[1], digits);
}

const front = (x: number, z: number) => point([x, -10, z], [0, -1, 0]);

describe('a drag keeps the touched point under the pointer', () => {
  test('of a picture from one side, in its plane', () => {
    const held = grip({ projection: 'planar', direction: [0, 1, 0], turn_deg: 30 }, front(1, 2));
    expectUnderPointer(held, front(4, -3));
    expect(moved(held, front(4, -3))).toEqual({ position_mm: [3, 0, -5] });
    // Another depth does not move the picture along the direction.
    expect(moved(held, point([4, -6, 2], [0, -1, 0]))).toEqual({ position_mm: [3, 0, 0] });
  });

  test('of a picture from below, also on a turned object', () => {
    for (const rotation of [kNone, turn('x', 70)])
      expectUnderPointer(grip({ projection: 'dip' }, front(1, 2), rotation), front(4, -3));
  });

  test('of a picture from three sides', () => {
    expectUnderPointer(grip({ projection: 'box' }, front(1, 2)), front(4, -3));
  });

  test('of a picture around the object, by a turn and a shift along the axis', () => {
    const held = grip({ projection: 'cylindrical', turn_deg: 10 }, front(0, 0));
    const right = point([10, 0, 5], [1, 0, 0]);
    expectUnderPointer(held, right);
    expect(moved(held, right)).toEqual({ turn_deg: 100, position_mm: [0, 0, 5] });
    expect(moved(held, point([10, 0, 0], [1, 0, 0]))).toEqual({ turn_deg: 100 });
  });

  test('of a decal, which looks against the normal of the surface', () => {
    const decal: PaintLayer = {
      projection: 'decal',
      position_mm: [0, -10, 0],
      direction: [0, 1, 0],
      size_mm: 10,
    };
    const held = grip(decal, front(1, 2));
    expectUnderPointer(held, front(4, -3));
    expect(moved(held, front(4, -3)).direction).toEqual([0, 1, 0]);
    // Around the edge, onto the right side.
    const right = point([10, 3, 4], [1, 0, 0]);
    expectUnderPointer(held, right);
    expect(moved(held, right)).toEqual({
      position_mm: [10, 2, 2],
      direction: [-1, 0, 0],
      up: undefined,
      size_mm: 10,
    });
  });

  test('of a decal that was touched beside its picture, by its middle', () => {
    const decal: PaintLayer = { projection: 'decal', position_mm: [0, -10, 0], size_mm: 2 };
    const right = point([10, 3, 4], [1, 0, 0]);
    expect(moved(grip(decal, front(9, 9)), right)).toMatchObject({
      position_mm: [10, 3, 4],
      direction: [-1, 0, 0],
    });
  });
});

describe('a decal keeps its upward direction', () => {
  test('on the way over the top', () => {
    const decal: PaintLayer = {
      projection: 'decal',
      position_mm: [0, 0, 10],
      direction: [0, 0, -1],
      size_mm: 10,
    };
    const held = grip(decal, point([0, 0, 10], [0, 0, 1]));
    const slope = moved(held, point([3, 0, 9], [0.6, 0, 0.8]));
    expect(slope).toMatchObject({ direction: [-0.6, 0, -0.8], up: [0, 1, 0] });
  });

  test('unless it would be along the direction of view', () => {
    const decal: PaintLayer = { projection: 'decal', direction: [0, 1, 0], up: [1, 0, 0] };
    const held = grip(decal, front(0, 0));
    const { direction, up } = moved(held, point([10, 0, 0], [1, 0, 0]));
    expect(direction).toEqual([-1, 0, 0]);
    expect(up).toBeUndefined();
  });
});

describe('size and turn', () => {
  const decal: PaintLayer = { projection: 'decal', direction: [0, 1, 0], turn_deg: 20 };

  test('a picture is scaled from the width that it has', () => {
    expect(scaled({ projection: 'planar' }, { width_mm: 40 }, 1.5)).toEqual({ size_mm: 60 });
    expect(scaled({ projection: 'planar', size_mm: 20 }, { width_mm: 40 }, 1.5)).toEqual({
      size_mm: 30,
    });
    expect(scaled({ projection: 'planar', size_mm: 1 }, { width_mm: 1 }, 0)).toEqual({
      size_mm: 0.1,
    });
  });

  test('Shift turns about the middle, counter-clockwise as seen', () => {
    expect(turned(grip(decal, front(5, 0)), front(0, 5))).toEqual({ turn_deg: 110 });
    expect(turned(grip(decal, front(5, 0)), front(0, -5))).toEqual({ turn_deg: -70 });
  });

  test('the sides of a box turn in their own planes', () => {
    const right = (y: number, z: number) => point([10, y, z], [1, 0, 0]);
    const box = grip({ projection: 'box' }, right(5, 0));
    expect(turned(box, right(0, 5))).toEqual({ turn_deg: 90 });
  });

  test('two fingers turn as the viewer sees it, also from behind', () => {
    expect(twisted(grip(decal, front(0, 0)), 15)).toEqual({ turn_deg: 35 });
    const behind = point([0, 10, 0], [0, 1, 0]);
    expect(twisted(grip({ ...decal, projection: 'planar' }, behind), 15)).toEqual({ turn_deg: 5 });
    // A picture from below is seen from behind at the top.
    const top = point([0, 0, 10], [0, 0, 1]);
    expect(twisted(grip({ projection: 'dip' }, top), 15)).toEqual({ turn_deg: -15 });
    const right = point([10, 0, 0], [1, 0, 0]);
    expect(twisted(grip({ projection: 'box' }, right), 15)).toEqual({ turn_deg: 15 });
  });

  test('angles stay within half a turn', () => {
    expect([190, -190, 540, -180, 0.04].map(roundedTurn)).toEqual([-170, 170, 180, 180, 0]);
  });
});

describe('gestures', () => {
  /** A screen in front of the cube: x to the right, y down, 10 pixels per mm, (100, 100) in the middle. */
  function screen(layer: PaintLayer) {
    const page = {
      layer,
      hit: (x: number, y: number) => {
        const [right, up] = [(x - 100) / 10, (100 - y) / 10];
        return Math.max(Math.abs(right), Math.abs(up)) <= 10 ? front(right, up) : undefined;
      },
      current: () => placed(page.layer),
      change: (part: Partial<PaintLayer>) => {
        page.layer = { ...page.layer, ...part };
      },
    };
    return { page, gestures: new PictureGestures(page) };
  }
  const kPlanar: PaintLayer = { projection: 'planar', direction: [0, 1, 0], size_mm: 10 };

  test('one finger moves the picture, from its first pixels on', () => {
    const { page, gestures } = screen(kPlanar);
    expect(gestures.down({ id: 1, x: 100, y: 100 }, false)).toBe(true);
    gestures.move({ id: 1, x: 101, y: 101 }, false);
    expect(page.layer).toBe(kPlanar);
    gestures.move({ id: 1, x: 110, y: 80 }, false);
    expect(page.layer.position_mm).toEqual([1, 0, 2]);
    // Beside the object the picture stays.
    gestures.move({ id: 1, x: 400, y: 80 }, false);
    expect(page.layer.position_mm).toEqual([1, 0, 2]);
    gestures.up(1);
    gestures.move({ id: 1, x: 120, y: 80 }, false);
    expect(page.layer.position_mm).toEqual([1, 0, 2]);
  });

  test('a finger beside the object is not taken', () => {
    const { gestures } = screen(kPlanar);
    expect(gestures.down({ id: 1, x: 400, y: 100 }, false)).toBe(false);
    expect(gestures.isActive).toBe(false);
  });

  test('Shift turns, also when it is pressed during a drag', () => {
    const { page, gestures } = screen(kPlanar);
    gestures.down({ id: 1, x: 140, y: 100 }, true);
    gestures.move({ id: 1, x: 100, y: 60 }, true);
    expect(page.layer).toEqual({ ...kPlanar, turn_deg: 90 });
    gestures.move({ id: 1, x: 100, y: 50 }, false);
    gestures.move({ id: 1, x: 110, y: 50 }, false);
    expect(page.layer).toMatchObject({ turn_deg: 90, position_mm: [1, 0, 0] });
  });

  test('two fingers scale and turn; the one that stays moves on from there', () => {
    const { page, gestures } = screen(kPlanar);
    gestures.down({ id: 1, x: 90, y: 100 }, false);
    gestures.down({ id: 2, x: 110, y: 100 }, false);
    gestures.move({ id: 2, x: 90, y: 60 }, false);
    expect(page.layer).toMatchObject({ size_mm: 20, turn_deg: 90 });
    gestures.up(2);
    gestures.move({ id: 1, x: 100, y: 100 }, false);
    expect(page.layer).toMatchObject({ size_mm: 20, turn_deg: 90, position_mm: [1, 0, 0] });
  });

  test('the wheel scales the picture on the object, but not beside it', () => {
    const { page, gestures } = screen(kPlanar);
    expect(gestures.wheel(400, 100, -100)).toBe(false);
    expect(gestures.wheel(100, 100, -1000 * Math.log(2))).toBe(true);
    expect(page.layer.size_mm).toBe(20);
  });
});

describe('a dropped picture', () => {
  const picture = { name: 'cat.png' };
  const at = front(1, 2);

  test('lands on the object if it comes alone', () => {
    expect(landing([picture], at)).toBe(picture);
    expect(landing([picture], undefined)).toBeUndefined();
    expect(landing([{ name: 'cat.stl' }], at)).toBeUndefined();
    expect(landing([picture, { name: 'cat.stl' }], at)).toBeUndefined();
    expect(landing([], at)).toBeUndefined();
  });

  test('is a decal there; its longer side is a third of the object', () => {
    expect(decalAt(at, 60, 2, kNone)).toEqual({
      projection: 'decal',
      position_mm: [1, -10, 2],
      direction: [0, 1, 0],
      size_mm: 20,
    });
    expect(decalAt(at, 60, 0.5, kNone).size_mm).toBe(10);
  });

  test('is upright in the view, also on a slope near the top and on a turned object', () => {
    expect(decalAt(point([0, 0, 9], [0.2, 0, 0.98]), 60, 1, kNone).up).toEqual([0, 1, 0]);
    const rotation = turn('x', 90);
    const { up } = decalAt(point([10, 0, 0], [1, 0, 0]), 60, 1, rotation);
    expect(rotate(rotation, up!)[2]).toBeCloseTo(1);
  });
});
