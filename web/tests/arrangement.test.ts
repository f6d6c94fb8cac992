import { describe, expect, test } from 'vitest';
import { arrange, remedyForMissing, type ModelFile } from '../src/model/arrangement';

const file = (name: string) => ({ name });
const mtl = (name: string, text: string) => ({ file: file(name), text });

/** An OBJ with a material library and texture coordinates, whose triangles have the material "m". */
const obj = (more: Partial<ModelFile['mesh']> = {}): ModelFile => ({
  name: 'spot.obj',
  mesh: {
    libraries: ['./spot.mtl'],
    parts: [{ material: 'm', first: 0, count: 3 }],
    uvs: new Float32Array(6),
    ...more,
  },
});
const kSkin = mtl('spot.mtl', 'newmtl m\nmap_Kd textures\\skin.png\n');

describe('the files of a print', () => {
  test('an image referenced by a material keeps the referenced name; another image is the texture', () => {
    const skin = file('Skin.PNG');
    const other = file('logo.png');
    const arranged = arrange(obj(), [kSkin], [skin, other]);
    expect(arranged.extra.map(({ name }) => name)).toEqual(['spot.mtl', 'textures/skin.png']);
    expect(arranged.texture).toBe(other);
    expect(arranged.missing).toEqual([]);
    expect(arranged.materials.get('m')?.file).toBe(skin);
  });

  test('a second texture is listed as unused', () => {
    const [a, b] = [file('a.png'), file('b.png')];
    const { texture, unused } = arrange(obj(), [], [a, b]);
    expect(texture).toBe(a);
    expect(unused).toEqual([b]);
  });

  test('names that differ only in their Unicode form are the same', () => {
    const text = `newmtl m\nmap_Kd ${'grün.png'.normalize('NFC')}\n`;
    const image = file('grün.png'.normalize('NFD'));
    expect(arrange(obj(), [mtl('spot.mtl', text)], [image]).missing).toEqual([]);
  });
});

describe('a missing texture', () => {
  test('is named with the file that refers to it', () => {
    const { missing } = arrange(obj(), [kSkin], []);
    expect(missing).toEqual([{ name: 'skin.png', by: 'spot.mtl' }]);
    expect(remedyForMissing(missing)).toBe(
      'Add "skin.png", which spot.mtl names, or choose another texture',
    );
  });

  test('of a glTF is named by the model itself', () => {
    const materials = new Map([['0 skin', { colour: [1, 1, 1] as const, map: 'a/skin.png' }]]);
    const parts = [{ material: '0 skin', first: 0, count: 3 }];
    const model = { name: 'spot.gltf', mesh: { ...obj().mesh, libraries: [], parts, materials } };
    expect(arrange(model as unknown as ModelFile, [], []).missing).toEqual([
      { name: 'skin.png', by: 'spot.gltf' },
    ]);
  });

  test('is no longer missing when the file, or a texture for the whole object, is added', () => {
    expect(arrange(obj(), [kSkin], [file('SKIN.png')]).missing).toEqual([]);
    expect(arrange(obj(), [kSkin], [file('logo.png')]).missing).toEqual([]);
    expect(arrange(obj(), [], [file('logo.png')]).missing).toEqual([]);
  });

  test('of a material that no triangle has is not needed', () => {
    const text = 'newmtl m\nKd 1 0 0\nnewmtl other\nmap_Kd other.png\n';
    expect(arrange(obj(), [mtl('spot.mtl', text)], []).missing).toEqual([]);
  });

  test('is counted once, and several are counted', () => {
    const text = 'newmtl m\nmap_Kd a.png\nnewmtl n\nmap_Kd A.png\nnewmtl o\nmap_Kd b.png\n';
    const parts = ['m', 'n', 'o'].map((material) => ({ material, first: 0, count: 3 }));
    const { missing } = arrange(obj({ parts }), [mtl('spot.mtl', text)], []);
    expect(missing.map(({ name }) => name)).toEqual(['A.png', 'b.png']);
    expect(remedyForMissing(missing)).toBe(
      'Add "A.png", which spot.mtl names, and 1 more file, or choose another texture',
    );
  });

  test('does not matter before there is a model, or if the model is that of a job', () => {
    expect(arrange(undefined, [kSkin], []).missing).toEqual([]);
    expect(remedyForMissing([])).toBeUndefined();
  });
});

describe('a missing material file', () => {
  test('is named by the model', () => {
    expect(arrange(obj(), [], []).missing).toEqual([{ name: 'spot.mtl', by: 'spot.obj' }]);
  });

  test('is not needed if the vertices have colours, or if the triangles have no material', () => {
    expect(arrange(obj({ colours: new Uint8Array(9) }), [], []).missing).toEqual([]);
    const parts = [{ material: '', first: 0, count: 3 }];
    expect(arrange(obj({ parts }), [], []).missing).toEqual([]);
  });

  test('may be one of several in a line', () => {
    const model = obj({ libraries: ['spot.mtl more.mtl'] });
    expect(arrange(model, [mtl('more.mtl', '')], []).missing).toEqual([]);
    expect(arrange(model, [mtl('other.mtl', '')], []).missing).toHaveLength(1);
  });
});

describe('a mesh without texture coordinates', () => {
  const stl: ModelFile = {
    name: 'bunny.stl',
    mesh: { libraries: [], parts: [{ material: '', first: 0, count: 3 }] },
  };

  test('takes a picture as its texture, whether it came before the model or after it', () => {
    const cat = file('cat.png');
    expect(arrange(undefined, [], [cat]).texture).toBe(cat);
    expect(arrange(stl, [], [cat])).toMatchObject({ texture: cat, missing: [], unused: [] });
  });

  test('takes the only image of its materials, which cannot be placed otherwise', () => {
    const { uvs: _, ...mesh } = obj().mesh;
    const skin = file('skin.png');
    const { texture, extra } = arrange({ name: 'spot.obj', mesh }, [kSkin], [skin]);
    expect(texture).toBe(skin);
    expect(extra.map(({ name }) => name)).toEqual(['spot.mtl']);
  });
});
