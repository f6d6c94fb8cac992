import { h, render } from 'preact';
import { useState } from 'preact/hooks';
import { afterEach, expect, test, vi } from 'vitest';
import { NumberField } from '../src/ui/controls';
import { TinyNode, tinyDocument } from './tiny_dom';

vi.stubGlobal('document', tinyDocument);

const told: (number | undefined)[] = [];
let setFromOutside: (value: number) => void;

function Form() {
  const [value, setValue] = useState<number>();
  setFromOutside = setValue;
  const tell = (next: number | undefined) => {
    told.push(next);
    setValue(next);
  };
  return h(NumberField, {
    label: 'Move to',
    unit: 'mm',
    value,
    min: 2,
    max: 298,
    onValue: tell,
    onEmpty: () => tell(undefined),
  });
}

function show(): { page: TinyNode; input: TinyNode } {
  const page = new TinyNode(1, 'main');
  told.length = 0;
  render(h(Form, {}), page as unknown as Element);
  return { page, input: page.find('input')! };
}

// Preact renders in a microtask. Its effects run 35 ms later if nothing paints.
const rendered = async () => {
  for (let i = 0; i < 20; i += 1) await Promise.resolve();
};
const painted = () => new Promise((resolve) => setTimeout(resolve, 100));

async function type(input: TinyNode, text: string): Promise<void> {
  input.fire('focus');
  for (const key of text) {
    input.value += key;
    input.fire('input');
    await rendered();
  }
}

afterEach(painted);

test('a number typed before the first paint stays as typed', async () => {
  const { page, input } = show();
  await type(input, '300');
  await painted();
  expect(input.value).toBe('300');
  expect(page.text).toContain('Out of range. Enter 2 to 298 mm.');
  expect(told.at(-1)).toBe(undefined);
});

test('a number in range that is typed before the first paint becomes the value', async () => {
  const { input } = show();
  await type(input, '30');
  await painted();
  expect(input.value).toBe('30');
  expect(told).toEqual([3, 30]);
});

test('a value set from outside replaces the text, but not during typing', async () => {
  const { input } = show();
  await type(input, '300');
  setFromOutside(20);
  await rendered();
  expect(input.value).toBe('300');
  input.fire('blur');
  await rendered();
  expect(input.value).toBe('20');
});
