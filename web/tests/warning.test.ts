import { h, render } from 'preact';
import { expect, test, vi } from 'vitest';
import type { Place, Warning } from '../src/api/types';
import { WarningLines, wordsOfPlace } from '../src/ui/warning';
import { TinyNode, tinyDocument } from './tiny_dom';

vi.stubGlobal('document', tinyDocument);

const words = (place: Omit<Place, 'dip'>, dip = 0) => wordsOfPlace({ dip, ...place });

test('each place has its words', () => {
  expect(words({ filmPoint: { xMm: -4, yMm: 17.5, immersionMm: 12.3 } })).toBe(
    '12.30 mm immersion, at (-4.00, 17.50) mm',
  );
  expect(words({ surface: true })).toBe('surface');
  expect(words({ immersionMm: 0 })).toBe('0.00 mm immersion');
  expect(words({ file: { name: 'mug.obj', line: 4 } })).toBe('mug.obj, line 4');
  expect(words({ file: { name: 'mug.obj', line: 0 } })).toBe('mug.obj');
  expect(words({ layer: 'logo' })).toBe('layer logo');
  expect(words({ sheet: 3 })).toBe('sheet 3');
  expect(words({ marker: 'left' })).toBe('marker left');
  expect(words({ resource: 'jobs/7' })).toBe('jobs/7');
  expect(words({ item: 'printer' })).toBe('printer');
});

test('a dip of a plan comes first', () => {
  expect(words({}, 2)).toBe('dip 2');
  expect(words({ surface: true }, 2)).toBe('dip 2, surface');
  expect(words({})).toBe('');
  expect(wordsOfPlace(undefined)).toBe('');
});

test('a warning is its message and its place', () => {
  const warnings: Warning[] = [
    { code: 'FILM_TORN', message: 'the film tears', where: { dip: 0, surface: true } },
    { code: 'FILM_LATE', message: 'activated 140 s ago' },
  ];
  const page = new TinyNode(1, 'main');
  render(h(WarningLines, { warnings }), page as unknown as Element);
  expect(page.text).toBe('the film tears. surfaceactivated 140 s ago.');
});
