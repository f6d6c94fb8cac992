import { h, render, type ComponentType } from 'preact';
import { expect, test, vi } from 'vitest';
import { beginnings } from '../src/events';
import { later } from '../src/ui/later';
import { TinyNode, tinyDocument } from './tiny_dom';

vi.stubGlobal('document', tinyDocument);

const Part: ComponentType<{ name: string }> = ({ name }) => h('p', {}, `Hello ${name}`);

function show(load: () => Promise<typeof Part>): TinyNode {
  const page = new TinyNode(1, 'main');
  render(h(later(load), { name: 'Otto' }), page as unknown as Element);
  return page;
}

test('a part is shown once its code is loaded', async () => {
  const page = show(() => Promise.resolve(Part));
  expect(page.text).toBe('Loading…');
  await vi.waitFor(() => expect(page.text).toBe('Hello Otto'));
});

test('code that cannot be loaded is said, and loaded once the daemon answers', async () => {
  const load = vi.fn<() => Promise<typeof Part>>().mockRejectedValueOnce(new Error('gone'));
  load.mockResolvedValue(Part);
  const page = show(load);
  await vi.waitFor(() => expect(page.text).toContain('could not be loaded. Reload the page'));
  expect(load).toHaveBeenCalledTimes(1);
  beginnings.value += 1;
  await vi.waitFor(() => expect(page.text).toBe('Hello Otto'));
});
