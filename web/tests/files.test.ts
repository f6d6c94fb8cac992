import { describe, expect, test } from 'vitest';
import { contradiction, nameFor, roleOf } from '../src/model/files';

const file = (name: string) => ({ name });
const bytes = (text: string) => new TextEncoder().encode(text);

describe('files', () => {
  test('are classified by their extension, ignoring case', () => {
    expect(roleOf('a.OBJ')).toBe('mesh');
    expect(roleOf('a.b.jpeg')).toBe('image');
    expect(roleOf('film.toml')).toBe('profile');
  });

  test.each(['part.step', 'all.zip', 'x.webp', 'noending', 'evil.html'])(
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

  test('are refused if they are empty, or if an image does not begin like one', () => {
    expect(contradiction('image', bytes('<svg/>'))).toBeDefined();
    expect(contradiction('image', new Uint8Array([0x89, 0x50, 0x4e, 0x47]))).toBeUndefined();
    expect(contradiction('mesh', bytes(''))).toBeDefined();
    // The worker decides whether a file is a model.
    expect(contradiction('mesh', bytes('anything'))).toBeUndefined();
  });

  test('with names that the API refuses are renamed', () => {
    expect(nameFor(file('skin 1.png'))).toBe('skin 1.png');
    expect(nameFor(file('--x<b>.png'))).toBe('x<b>.png');
    expect(nameFor(file('a/b\n.png'))).toBe('a_b_.png');
    expect(nameFor(file('..'))).toBe('file');
  });
});
