import { describe, expect, test } from 'vitest';
import type { ModelSummary } from '../src/api/types';
import { arrange, remedyForMissing } from '../src/model/arrangement';
import { summaryOf } from './shapes';

const file = (name: string) => ({ name });

/** A model with texture coordinates whose colours come from these files. */
const coloured = (companions: ModelSummary['companions']) =>
  summaryOf({ companions, hasTextureCoordinates: true, hasColour: true });
const named = (name: string) => ({ name, isMissing: false });
const kMtl = named('spot.mtl');

describe('the files of a print', () => {
  test('an image that the model names belongs to it; another image is the texture', () => {
    const [mtl, skin, other] = [file('spot.mtl'), file('Skin.PNG'), file('logo.png')];
    const arranged = arrange(coloured([kMtl, named('maps/skin.png')]), [mtl], [skin, other]);
    expect(arranged.extra).toEqual([
      { name: 'spot.mtl', file: mtl },
      { name: 'Skin.PNG', file: skin },
    ]);
    expect(arranged).toMatchObject({ texture: other, missing: [], hasOwnColours: true });
  });

  test('a second texture is listed as unused', () => {
    const [a, b] = [file('a.png'), file('b.png')];
    const { texture, unused } = arrange(coloured([]), [], [a, b]);
    expect(texture).toBe(a);
    expect(unused).toEqual([b]);
  });

  test('names that differ only in their Unicode form, folder or slashes are the same', () => {
    for (const name of ['grün.png'.normalize('NFC'), 'C:\\maps\\grün.png']) {
      const image = file('grün.png'.normalize('NFD'));
      expect(arrange(coloured([named(name)]), [], [image]).texture).toBeUndefined();
    }
  });

  test('a file whose name the API refuses gets another name', () => {
    const { extra } = arrange(coloured([]), [file('--x<b>.mtl')], []);
    expect(extra[0]!.name).toBe('x<b>.mtl');
  });
});

describe('a missing file', () => {
  const missing = (...names: string[]) =>
    coloured(names.map((name) => ({ name, isMissing: true })));

  test('is named with a remedy', () => {
    const arranged = arrange(missing('textures/skin.png'), [], []);
    expect(arranged.missing).toEqual(['skin.png']);
    expect(remedyForMissing(arranged.missing)).toBe(
      'Add "skin.png", which the model names, or choose another texture',
    );
  });

  test('is not needed if the object has a texture', () => {
    expect(arrange(missing('skin.png'), [], [file('logo.png')]).missing).toEqual([]);
  });

  test('is counted once, and several are counted', () => {
    const arranged = arrange(missing('x/a.png', 'a.png', 'b.png'), [], []);
    expect(arranged.missing).toEqual(['a.png', 'b.png']);
    expect(remedyForMissing(arranged.missing)).toBe(
      'Add "a.png", which the model names, and 1 more file, or choose another texture',
    );
    expect(remedyForMissing(['a.png', 'b.png', 'c.png'])).toContain(', and 2 more files, or');
  });

  test('is unknown before there is a model', () => {
    expect(arrange(undefined, [file('spot.mtl')], []).missing).toEqual([]);
    expect(remedyForMissing([])).toBeUndefined();
  });
});

describe('a mesh without texture coordinates', () => {
  test('takes a picture as its texture, whether it came before the model or after it', () => {
    const cat = file('cat.png');
    expect(arrange(undefined, [], [cat]).texture).toBe(cat);
    expect(arrange(summaryOf(), [], [cat])).toMatchObject({
      texture: cat,
      missing: [],
      unused: [],
    });
  });

  test('takes the only image that it names, which cannot be placed otherwise', () => {
    const [mtl, skin] = [file('spot.mtl'), file('skin.png')];
    const summary = summaryOf({ companions: [kMtl, named('skin.png')] });
    const { texture, extra } = arrange(summary, [mtl], [skin]);
    expect(texture).toBe(skin);
    expect(extra.map(({ name }) => name)).toEqual(['spot.mtl']);
  });

  test('takes none of several images that it names', () => {
    const images = [named('skin.png'), named('eyes.png')];
    const arranged = arrange(summaryOf({ companions: images }), [], images);
    expect(arranged.texture).toBeUndefined();
    expect(arranged).toMatchObject({ hasOwnColours: false, unused: [] });
  });
});
