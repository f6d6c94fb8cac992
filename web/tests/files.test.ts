import { describe, expect, test } from 'vitest';
import { contradiction, isPlain, nameFor, roleOf } from '../src/model/files';

const file = (name: string) => ({ name });
const bytes = (text: string) => new TextEncoder().encode(text);

describe('files', () => {
  test('are classified by their extension, ignoring case', () => {
    expect(roleOf('a.OBJ')).toBe('mesh');
    expect(roleOf('a.b.jpeg')).toBe('image');
    expect(roleOf('film.toml')).toBe('profile');
  });

  test.each(['part.step', 'scene.bin', 'all.zip', 'x.webp', 'noending', 'evil.html'])(
    '%s is refused with a remedy',
    (name) => {
      const role = roleOf(name);
      expect(typeof role).toBe('object');
      if (typeof role === 'object') expect(role.why).toMatch(/Export|Unpack|Save|Drop/);
    },
  );

  test('without an extension are refused as what they may be: folders', () => {
    expect(roleOf('textures')).toEqual({ why: expect.stringContaining('If this is a folder') });
  });

  test('are refused if their first bytes contradict their name', () => {
    expect(contradiction('image', 'a.png', bytes('<svg/>'))).toBeDefined();
    expect(
      contradiction('image', 'a.png', new Uint8Array([0x89, 0x50, 0x4e, 0x47])),
    ).toBeUndefined();
    expect(contradiction('mesh', 'a.ply', bytes('solid x'))).toBeDefined();
    expect(contradiction('mesh', 'a.obj', bytes('MZ\0\0'))).toBeDefined();
    expect(contradiction('mesh', 'a.obj', bytes('# by hand\nv 1 2 3'))).toBeUndefined();
    expect(contradiction('mesh', 'a.stl', bytes(''))).toBeDefined();
  });

  test('with names that the API refuses are renamed', () => {
    for (const name of ['../x', '/x', 'a//b', 'a/./b', '-rf', 'a\nb', '', 'x'.repeat(256)])
      expect(isPlain(name)).toBe(false);
    expect(isPlain('textures/skin 1.png')).toBe(true);
    expect(nameFor(file('skin.png'), ['../../skin.png'])).toBe('skin.png');
    expect(nameFor(file('--x<b>.png'), [])).toBe('x<b>.png');
    expect(nameFor(file('..'), [])).toBe('file');
  });
});
