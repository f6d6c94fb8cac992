import { describe, expect, test } from 'vitest';
import type { SimulateSpec } from '../src/api/types';
import { turn, type Quaternion } from '../src/model/pose';
import {
  enlarged,
  fitted,
  layerIn,
  onlyChosen,
  projectionIn,
  withProjection,
  type LayerChoices,
} from '../src/screens/new_print/picture/choices';
import { axisOf, around, lookFrom, sideOf } from '../src/screens/new_print/picture/directions';
import { layerOfOldDraft, pictureOf, pictureSpec } from '../src/screens/new_print/picture/spec';

const kTexture = { name: 'cat.png', asset: 'assets/2' };
const kNone: Quaternion = [1, 0, 0, 0];
const kDecal: LayerChoices = {
  projection: 'decal',
  position_mm: [1, 2, 3],
  direction: [0, 1, 0],
  size_mm: 20,
  depth_mm: 5,
  turn_deg: 30,
  mirror: true,
  opacity: 0.5,
};

/** The spec as a job returns it, with the defaults of fields that were not sent. */
function received(layers: object[], more: object = {}): SimulateSpec {
  const empty = { name: '', positionMm: [], direction: [], up: [], mirror: false };
  const paint = { layers: layers.map((layer) => ({ ...empty, ...layer })), ...more };
  return { paint } as unknown as SimulateSpec;
}

describe('the picture in a spec', () => {
  test('is a texture as long as nothing was chosen', () => {
    expect(pictureSpec(kTexture, {}, false)).toEqual({ texture: kTexture });
    expect(pictureSpec(kTexture, { projection: 'uv' }, true)).toEqual({ texture: kTexture });
  });

  test('is a layer with the choices', () => {
    const [layer] = pictureSpec(kTexture, kDecal, false).paint!.layers!;
    expect(layer).toEqual({
      picture: kTexture,
      projection: 'decal',
      positionMm: [1, 2, 3],
      direction: [0, 1, 0],
      sizeMm: 20,
      depthMm: 5,
      turnDeg: 30,
      mirror: true,
      opacity: 0.5,
    });
  });

  test('leaves the projection to the worker if only other options were chosen', () => {
    const { paint } = pictureSpec(kTexture, { size_mm: 60 }, false);
    expect(paint!.layers).toEqual([{ picture: kTexture, sizeMm: 60 }]);
  });

  test('has no options that its projection refuses', () => {
    const { paint } = pictureSpec(kTexture, { ...kDecal, projection: 'dip', repeat: true }, false);
    expect(Object.keys(paint!.layers![0]!)).not.toContain('depthMm');
    expect(Object.keys(paint!.layers![0]!)).not.toContain('direction');
    expect(paint!.layers![0]!.repeat).toBe(true);
  });

  test('lies above the own colours of the model if it is a decal', () => {
    expect(pictureSpec(kTexture, kDecal, true).paint!.layers).toHaveLength(2);
    expect(pictureSpec(kTexture, kDecal, true).paint!.layers![0]).toEqual({ projection: 'uv' });
    expect(pictureSpec(kTexture, { projection: 'box' }, true).paint!.layers).toHaveLength(1);
  });

  test.each([true, false])('is read back from a job (own colours: %s)', (hasOwnColours) => {
    const { layers } = pictureSpec(kTexture, kDecal, hasOwnColours).paint!;
    expect(pictureOf(received(layers!))).toEqual({
      texture: kTexture,
      layer: kDecal,
      hasOwnColours,
    });
  });

  test('is read back from the short forms, and from an old draft', () => {
    const spec = { texture: kTexture, project: 'box', projectSizeMm: 60, projectTurnDeg: -5 };
    const layer = { projection: 'box', size_mm: 60, turn_deg: -5 };
    expect(pictureOf(spec as unknown as SimulateSpec)).toMatchObject({ texture: kTexture, layer });
    expect(layerOfOldDraft({ kind: 'box', size_mm: 60, turn_deg: -5 })).toEqual(layer);
  });

  test('is unknown to this page if the paint has other parts', () => {
    const picture = { picture: kTexture };
    expect(pictureOf(received([picture]))).toBeDefined();
    expect(pictureOf(received([picture, picture]))).toBeUndefined();
    expect(pictureOf(received([{ colour: '#ff0000' }]))).toBeUndefined();
    expect(pictureOf(received([picture], { baseColour: '#ff0000' }))).toBeUndefined();
    expect(
      pictureOf(received([{ projection: 'uv' }, { ...picture, projection: 'box' }])),
    ).toBeUndefined();
  });
});

describe('the choices', () => {
  test('give a layer; without a projection, the worker’s default', () => {
    expect(projectionIn({}, true)).toBe('dip');
    expect(projectionIn({}, false)).toBe('uv');
    expect(projectionIn({ projection: 'uv' }, true)).toBe('dip');
    expect(layerIn({ size_mm: 60, opacity: 0.5 }, true)).toEqual({
      projection: 'dip',
      size_mm: 60,
      opacity: 0.5,
    });
    expect(layerIn({ size_mm: 60, opacity: 0.5 }, false)).toEqual({
      projection: 'uv',
      opacity: 0.5,
    });
    expect(onlyChosen({ size_mm: undefined, mirror: true })).toEqual({ mirror: true });
  });

  test('keep what belongs to the picture when the projection changes', () => {
    const kept = { mirror: true, opacity: 0.5, turn_deg: 30 };
    expect(withProjection(kDecal, 'box', kNone)).toEqual({ projection: 'box', ...kept });
    expect(withProjection(kDecal, 'cylindrical', kNone).turn_deg).toBeUndefined();
    const { depth_mm: _, ...placed } = kDecal;
    expect(withProjection(kDecal, 'planar', kNone)).toEqual({ ...placed, projection: 'planar' });
    expect(withProjection(kDecal, 'decal', kNone)).toBe(kDecal);
  });

  test('look from the front of the view if a direction is needed', () => {
    expect(withProjection({}, 'planar', kNone)).toEqual({
      projection: 'planar',
      direction: [0, 1, 0],
    });
    expect(withProjection({}, 'decal', turn('z', 90)).direction).toEqual([1, 0, 0]);
  });

  test('can be fitted to the object again', () => {
    expect(fitted(kDecal)).toEqual({ projection: 'decal', direction: [0, 1, 0], opacity: 0.5 });
  });

  test('grow with the object', () => {
    expect(enlarged(kDecal, 2)).toMatchObject({
      position_mm: [2, 4, 6],
      size_mm: 40,
      depth_mm: 10,
      turn_deg: 30,
    });
    expect(enlarged({}, 2)).toEqual({});
  });
});

describe('directions', () => {
  test('are those of the view, also on a turned object', () => {
    expect(lookFrom('above', kNone)).toEqual({ direction: [0, 0, -1] });
    // The object lies on its back: what the view shows in front is its top.
    const onItsBack = turn('x', 90);
    expect(lookFrom('front', onItsBack)).toEqual({ direction: [0, 0, -1] });
    expect(lookFrom('right', onItsBack)).toEqual({ direction: [-1, 0, 0], up: [0, 1, 0] });
    expect(sideOf([0, 0, -1], onItsBack)).toBe('front');
    expect(sideOf(undefined, kNone)).toBe('below');
    expect(sideOf([1, 1, 0], kNone)).toBeUndefined();
  });

  test('have no up direction if the default is right', () => {
    for (const side of ['below', 'front', 'left', 'above'] as const)
      expect(lookFrom(side, kNone).up).toBeUndefined();
  });

  test('of a cylinder are an axis and its front', () => {
    expect(around('upright', kNone)).toEqual({});
    expect(around('sideways', kNone)).toEqual({ direction: [0, 1, 0], up: [1, 0, 0] });
    expect(axisOf({}, kNone)).toBe('upright');
    expect(axisOf({ direction: [0, 1, 0], up: [1, 0, 0] }, turn('z', 90))).toBe('forward');
  });
});
