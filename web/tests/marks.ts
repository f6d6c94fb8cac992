/** The marks of refused fields, as an input shows them. */
import { h, render } from 'preact';
import { vi } from 'vitest';
import type { Field } from '../src/model/fields';
import { useRefusal } from '../src/ui/field_errors';
import { TinyNode, tinyDocument } from './tiny_dom';

vi.stubGlobal('document', tinyDocument);

/** The problem that is shown at a field; undefined if it is not marked. */
export function markOf(field: Field): string | undefined {
  let mark: string | undefined;
  const Input = () => ((mark = useRefusal(field, 0)), null);
  render(h(Input, {}), new TinyNode(1, 'main') as unknown as Element);
  return mark;
}
