import { describe, expect, test } from 'vitest';
import { arrange, contradiction, isPlain, nameFor, roleOf } from '../src/model/files';

const file = (name: string) => ({ name });
const bytes = (text: string) => new TextEncoder().encode(text);

describe('files', () => {
  test('are told apart by their endings, whatever the case', () => {
    expect(roleOf('a.OBJ')).toBe('mesh');
    expect(roleOf('a.b.jpeg')).toBe('image');
    expect(roleOf('film.toml')).toBe('profile');
  });

  test.each(['part.step', 'scene.bin', 'all.zip', 'x.webp', 'noending', 'evil.html'])(
    '%s is refused with what to do',
    (name) => {
      const role = roleOf(name);
      expect(typeof role).toBe('object');
      if (typeof role === 'object') expect(role.why).toMatch(/Export|Unpack|Save|Drop/);
    },
  );

  test('whose first bytes are something else are refused', () => {
    expect(contradiction('image', 'a.png', bytes('<svg/>'))).toBeDefined();
    expect(
      contradiction('image', 'a.png', new Uint8Array([0x89, 0x50, 0x4e, 0x47])),
    ).toBeUndefined();
    expect(contradiction('mesh', 'a.ply', bytes('solid x'))).toBeDefined();
    expect(contradiction('mesh', 'a.obj', bytes('MZ\0\0'))).toBeDefined();
    expect(contradiction('mesh', 'a.obj', bytes('# by hand\nv 1 2 3'))).toBeUndefined();
    expect(contradiction('mesh', 'a.stl', bytes(''))).toBeDefined();
  });

  test('a picture that a material names comes under that name; another is the texture of the whole', () => {
    const skin = file('Skin.PNG');
    const other = file('logo.png');
    const mtl = { file: file('a.mtl'), text: 'newmtl m\nmap_Kd textures\\skin.png\n' };
    const arranged = arrange(['./a.mtl'], [mtl], [skin, other]);
    expect(arranged.extra.map(({ name }) => name)).toEqual(['a.mtl', 'textures/skin.png']);
    expect(arranged.texture).toBe(other);
    expect(arranged.missing).toEqual([]);
    expect(arranged.materials.get('m')?.file).toBe(skin);
  });

  test('what is named and missing is told', () => {
    const { missing } = arrange(
      ['b.mtl'],
      [{ file: file('a.mtl'), text: 'newmtl m\nmap_Kd x.png' }],
      [],
    );
    expect(missing).toEqual(['the material file "b.mtl"', 'the picture "x.png" of material "m"']);
  });

  test('names that are no plain names are not passed on', () => {
    for (const name of ['../x', '/x', 'a//b', 'a/./b', '-rf', 'a\nb', '', 'x'.repeat(256)])
      expect(isPlain(name)).toBe(false);
    expect(isPlain('textures/skin 1.png')).toBe(true);
    expect(nameFor(file('skin.png'), ['../../skin.png'])).toBe('skin.png');
    expect(nameFor(file('--x<b>.png'), [])).toBe('x<b>.png');
    expect(nameFor(file('..'), [])).toBe('file');
  });
});
