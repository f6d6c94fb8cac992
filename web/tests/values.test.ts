import { describe, expect, test } from 'vitest';
import { colourOf, kNoValue, place, ticks } from '../src/model/colour_map';
import { filmOf } from '../src/model/film';
import { readGrey16 } from '../src/model/grey16';
import { cutToBytes, limitsOf } from '../src/model/limits';
import { fit, pan, pixelAt, zoomAt } from '../src/model/pan_zoom';
import { readPositions } from '../src/model/positions';
import {
  formatBytes,
  formatSeconds,
  formatSize,
  formatTime,
  likelyUnit,
  oddSize,
  parseNumber,
  readNumber,
  secondsOf,
  unitOf,
} from '../src/model/units';

describe('figures', () => {
  test('are formatted with a suitable unit', () => {
    expect([0.25, 59.4, 125, 7300, 200_000, -5].map(formatSeconds)).toEqual([
      '250 ms',
      '59 s',
      '2 min 05 s',
      '2 h 01 min',
      '2 d 7 h',
      '-5 s',
    ]);
    expect([0, 999, 1500, 4_293_056].map(formatBytes)).toEqual([
      '0 B',
      '999 B',
      '1.5 kB',
      '4.3 MB',
    ]);
    expect(secondsOf('3.5s')).toBe(3.5);
    expect(secondsOf('3.5')).toBeNaN();
  });

  test('of times are more precise the nearer the time is', () => {
    const now = new Date(2026, 10, 22, 12, 0);
    const at = (...when: [number, number, number]) => formatTime(new Date(...when, 9, 5), now);
    expect(at(2026, 10, 22)).toBe('09:05');
    expect(at(2026, 10, 19)).toBe('Thu 09:05');
    expect(at(2026, 9, 3)).toBe('3 Oct 09:05');
    expect(at(2027, 10, 22)).toBe('22 Nov 2027');
  });

  test('are parsed with a decimal point or comma; other text is refused', () => {
    expect(parseNumber(' 1,5 ')).toBe(1.5);
    expect(parseNumber('-2e1')).toBe(-20);
    for (const text of ['', '.', 'x', '1.2.3', 'Infinity', '1e999', '1 mm', '0x10', '1e', '--1'])
      expect(parseNumber(text)).toBeUndefined();
  });

  test('with a comma that may separate thousands are refused', () => {
    expect(parseNumber('1,000')).toBeUndefined();
    expect(parseNumber('-12,500')).toBeUndefined();
    expect(['0,125', '1,25', '1,0000', '1000,5'].map(parseNumber)).toEqual([
      0.125, 1.25, 1, 1000.5,
    ]);
  });

  test('out of range are refused with the range', () => {
    const range = { min: 2, max: 298, unit: 'mm' };
    const read = (text: string) => {
      const number = readNumber(text, range);
      return number.ok ? number.value : `${number.failure.what}. ${number.failure.remedy}.`;
    };
    expect(['2', '298', ' 12,5 '].map(read)).toEqual([2, 298, 12.5]);
    for (const text of ['300', '298.001', '1.999', '-5', '1e3'])
      expect(read(text)).toBe('Out of range. Enter 2 to 298 mm.');
    expect(read('3O')).toBe('Not a number. Enter 2 to 298 mm.');
    expect(read(' ')).toBe('Number missing. Enter 2 to 298 mm.');
  });
});

describe('rules of the API', () => {
  test('give a field its unit, range and default', () => {
    expect(limitsOf({ min: 20, max: 2400, unit: 'dots per inch', usual: 300 })).toEqual({
      unit: 'dpi',
      min: 20,
      max: 2400,
      placeholder: '300',
    });
    expect(limitsOf({ unit: 'mm' })).toEqual({ unit: 'mm', min: -Infinity, max: Infinity });
  });

  test('limit texts by bytes without splitting a character', () => {
    expect(cutToBytes('mug', 3)).toBe('mug');
    expect(cutToBytes('mugs', 3)).toBe('mug');
    expect(cutToBytes('aää', 4)).toBe('aä');
    expect(cutToBytes('😀', 3)).toBe('');
  });
});

describe('films', () => {
  test('are recognized by name and by size', () => {
    expect(filmOf('A4')).toMatchObject({ width_mm: 210, height_mm: 297 });
    expect(filmOf('100x50.5')).toMatchObject({ width_mm: 100, height_mm: 50.5 });
    expect(filmOf('circle:105')).toMatchObject({ width_mm: 210, radius_mm: 105 });
    for (const name of ['A5', '0x10', 'circle:0', '10x', 'polygon:x'])
      expect(filmOf(name)).toBeUndefined();
  });
});

describe('colour maps', () => {
  test('increase in lightness from end to end, so they can be read without seeing hue', () => {
    for (const map of ['viridis', 'cividis'] as const) {
      let before = -1;
      for (let i = 0; i <= 100; i += 1) {
        const [r, g, b] = colourOf(map, i / 100);
        const lightness =
          0.2126 * (r / 255) ** 2.2 + 0.7152 * (g / 255) ** 2.2 + 0.0722 * (b / 255) ** 2.2;
        expect(lightness).toBeGreaterThan(before - 0.002);
        before = lightness;
      }
    }
  });

  test('clamp values and have a separate colour for missing values', () => {
    expect(colourOf('viridis', -1)).toEqual(colourOf('viridis', 0));
    expect(colourOf('viridis', 7)).toEqual(colourOf('viridis', 1));
    expect(colourOf('viridis', NaN)).toEqual(kNoValue);
  });

  test('with a logarithmic scale have the geometric mean of the ends in the middle', () => {
    const scale = { map: 'viridis', min: 1, max: 4, log: true } as const;
    expect(place(scale, 2)).toBeCloseTo(0.5);
    expect(ticks({ map: 'viridis', min: 0, max: 23.9 })).toEqual([0, 5, 10, 15, 20]);
    expect(ticks({ map: 'viridis', min: 3, max: 3 })).toEqual([3]);
  });
});

describe('a picture in its window', () => {
  const picture = { width: 1000, height: 2000 };
  const window = { width: 500, height: 500 };

  test('is fully visible at first', () => {
    expect(fit(picture, window)).toEqual({ zoom: 0.25, x: 125, y: 0 });
  });

  test('keeps the pixel under the pointer when zooming', () => {
    const view = fit(picture, window);
    const nearer = zoomAt(view, 10, 200, 300, 0.1);
    expect(pixelAt(nearer, 200, 300, picture)).toEqual(pixelAt(view, 200, 300, picture));
    expect(pixelAt(view, 10, 10, picture)).toBeUndefined();
  });

  test('cannot be moved out of the window', () => {
    const away = pan(fit(picture, window), 1e6, -1e6, picture, window);
    expect(away.x).toBeLessThan(window.width);
    expect(away.y + away.zoom * picture.height).toBeGreaterThan(0);
  });
});

describe('files of the daemon', () => {
  test('positions are read up to the end of an incomplete record', () => {
    const text = 't_s,depth_mm,position_mm\n0.0,-20.0,100.5\n0.1,-19.5,101.0\n0.2,-1';
    expect(readPositions(text)).toEqual([
      { t_s: 0, position_mm: 100.5 },
      { t_s: 0.1, position_mm: 101 },
    ]);
    expect(readPositions('nothing')).toEqual([]);
  });

  test('a 16-bit PNG is read at full depth', async () => {
    const values = [0, 1, 255, 256, 1000, 65535];
    const png = await grey16Png(3, 2, values);
    const picture = await readGrey16(png);
    expect([picture.width, picture.height]).toEqual([3, 2]);
    expect([...picture.values]).toEqual(values);
    await expect(readGrey16(png.slice(0, 40))).rejects.toThrow();
  });
});

/** A PNG whose second row is encoded as differences from the first. */
async function grey16Png(width: number, height: number, values: number[]): Promise<ArrayBuffer> {
  const bytes = values.flatMap((value) => [value >> 8, value & 255]);
  const rows = Array.from({ length: height }, (_, y) => {
    const row = bytes.slice(2 * width * y, 2 * width * (y + 1));
    const above = bytes.slice(2 * width * (y - 1), 2 * width * y);
    return y === 0 ? [0, ...row] : [2, ...row.map((value, i) => (value - above[i]!) & 255)];
  }).flat();
  const deflated = await new Response(
    new Blob([Uint8Array.from(rows)]).stream().pipeThrough(new CompressionStream('deflate')),
  ).arrayBuffer();
  const number = (value: number) => [24, 16, 8, 0].map((shift) => (value >>> shift) & 255);
  const chunk = (name: string, data: number[]) => [
    ...number(data.length),
    ...[...name].map((c) => c.charCodeAt(0)),
    ...data,
    ...number(0),
  ];
  return Uint8Array.from([
    0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10,
    ...chunk('IHDR', [...number(width), ...number(height), 16, 0, 0, 0, 0]),
    ...chunk('IDAT', [...new Uint8Array(deflated)]),
    ...chunk('IEND', []),
  ]).buffer; // prettier-ignore
}

describe('the unit of a model', () => {
  test('is recognised by its length, and other scales are custom', () => {
    expect([1, 10, 25.4, 1000, 15].map((length) => unitOf(length)?.name)).toEqual([
      'mm',
      'cm',
      'inch',
      'm',
      undefined,
    ]);
    // A scale that was computed from a length may differ in its last digit.
    expect(unitOf((25.4 * 30) / 30.000000000000004)?.name).toBe('inch');
  });

  test('is in doubt below 5 mm and above 1,000 mm', () => {
    expect([0.06, 4.999, 5, 120, 1000, 1000.1].map(oddSize)).toEqual([
      'small',
      'small',
      '',
      '',
      '',
      'large',
    ]);
  });

  test('is likely that of the file format, or else one that gives a usual size', () => {
    const names = [0.06, 0.2, 2, 0.8, 4, 60, 3000, 0.001].map((side) => likelyUnit(side)?.name);
    expect(names).toEqual(['m', 'm', 'inch', 'm', 'inch', 'mm', undefined, undefined]);
    expect(likelyUnit(0.9, 1000)?.name).toBe('m');
    expect(likelyUnit(60, 1000)?.name).toBe('mm');
  });

  test('gives a size that is shown with 0.1 mm or three digits', () => {
    expect(formatSize([60, 40.04, 120.5])).toBe('60.0 × 40.0 × 120.5 mm');
    expect(formatSize([0.0321, 0, 2500])).toBe('0.0321 × 0 × 2,500 mm');
    expect(formatSize([999.96, 9.999, 5])).toBe('1,000 × 10 × 5 mm');
  });
});
