/** The fields of a form whose text cannot be used. The form's action waits until there are none. */
import { useSignal, type Signal } from '@preact/signals';
import { createContext } from 'preact';
import { useContext, useId, useLayoutEffect } from 'preact/hooks';

/** Labels of the fields, by an id of each. */
export type FieldErrors = Signal<ReadonlyMap<string, string>>;

const Context = createContext<FieldErrors | undefined>(undefined);

/** Surrounds the fields of one form. */
export const FieldErrorsOf = Context.Provider;

export const useFieldErrors = (): FieldErrors => useSignal<ReadonlyMap<string, string>>(new Map());

/** Those of the form around this component. */
export const useFormErrors = (): FieldErrors | undefined => useContext(Context);

/** Tells the form around a field whether the field's text can be used. */
export function useReportError(label: string, hasError: boolean): void {
  const id = useId();
  const errors = useFormErrors();
  // Before anybody can press a button.
  useLayoutEffect(() => {
    if (!errors || !hasError) return undefined;
    errors.value = new Map(errors.value).set(id, label);
    return () => {
      errors.value = new Map([...errors.value].filter(([other]) => other !== id));
    };
  }, [errors, hasError, id, label]);
}

/** What to do before the form's action; undefined if nothing holds it up. */
export function remedyOf(errors: FieldErrors | undefined): string | undefined {
  const [label] = errors?.value.values() ?? [];
  return label === undefined ? undefined : `Correct “${label}” first`;
}
