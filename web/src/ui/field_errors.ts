/** The invalid fields of a form, which block the form's action, and fields that the daemon refused, which do not. */
import { signal, useSignal, type Signal } from '@preact/signals';
import { createContext } from 'preact';
import { useContext, useId, useLayoutEffect, useRef } from 'preact/hooks';
import { fieldAt, type Field } from '../model/fields';
import type { Violation } from '../model/result';

/** Labels of the invalid fields, by field id. */
export type FieldErrors = Signal<ReadonlyMap<string, string>>;

const Context = createContext<FieldErrors | undefined>(undefined);

/** Wraps the fields of one form. */
export const FieldErrorsOf = Context.Provider;

export const useFieldErrors = (): FieldErrors => useSignal<ReadonlyMap<string, string>>(new Map());

/** The invalid fields of the form that contains this component. */
export const useFormErrors = (): FieldErrors | undefined => useContext(Context);

/** Reports to the enclosing form whether the field is invalid. */
export function useReportError(label: string, hasError: boolean): void {
  const id = useId();
  const errors = useFormErrors();
  // A layout effect runs before a button can be pressed.
  useLayoutEffect(() => {
    if (!errors || !hasError) return undefined;
    errors.value = new Map(errors.value).set(id, label);
    return () => {
      errors.value = new Map([...errors.value].filter(([other]) => other !== id));
    };
  }, [errors, hasError, id, label]);
}

/** Returns a remedy for the first invalid field; undefined if all fields are valid. */
export function remedyOf(errors: FieldErrors | undefined): string | undefined {
  const [label] = errors?.value.values() ?? [];
  return label === undefined ? undefined : `Correct “${label}” first`;
}

/** What the daemon refused. */
type Subject = 'job' | 'preview';

interface Refusal extends Field {
  problem: string;
  of: Subject;
}

const refusals = signal<readonly Refusal[]>([]);

/** Marks the fields at fault, instead of those that were marked before for the same subject. */
export function markRefused(of: Subject, violations: readonly Violation[] = []): void {
  const marked = violations.flatMap(({ field, description }) => {
    const known = fieldAt(field);
    return known ? [{ ...known, problem: description, of }] : [];
  });
  refusals.value = [...refusals.value.filter((one) => one.of !== of), ...marked];
}

/** The problem that the daemon found in a field, as a sentence; undefined once the value changes. */
export function useRefusal(field: Field | undefined, value: unknown): string | undefined {
  const refusal = refusals.value.find(
    ({ name, dip }) => name === field?.name && (dip === undefined || dip === (field.dip ?? 0)),
  );
  const valueBefore = useRef(value);
  useLayoutEffect(() => {
    if (refusal && valueBefore.current !== value)
      refusals.value = refusals.value.filter((one) => one !== refusal);
    valueBefore.current = value;
  }, [value]);
  return refusal && `${refusal.problem}.`;
}
