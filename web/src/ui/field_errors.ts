/** The invalid fields of a form. The form's action is blocked until there are none. */
import { useSignal, type Signal } from '@preact/signals';
import { createContext } from 'preact';
import { useContext, useId, useLayoutEffect } from 'preact/hooks';

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
