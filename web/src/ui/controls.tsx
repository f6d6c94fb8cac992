/** Controls shared by all screens. */
import type { ComponentChildren, JSX } from 'preact';
import { useEffect, useId, useLayoutEffect, useRef, useState } from 'preact/hooks';
import type { Field } from '../model/fields';
import { cutToBytes } from '../model/limits';
import { done, type Result } from '../model/result';
import { parseNumber, readNumber } from '../model/units';
import { useRefusal, useReportError } from './field_errors';

/** A button that is marked busy and ignores further presses while its action runs. */
export function Button(props: {
  children: ComponentChildren;
  onPress: () => unknown;
  kind?: 'primary' | 'danger' | 'plain' | undefined;
  disabled?: boolean;
  label?: string;
  title?: string;
}) {
  const [isBusy, setBusy] = useState(false);
  const press = async () => {
    if (isBusy) return;
    setBusy(true);
    await props.onPress();
    setBusy(false);
  };
  // A busy button is not `disabled`, because it would lose keyboard focus.
  return (
    <button
      type="button"
      class={props.kind ?? ''}
      disabled={props.disabled}
      aria-disabled={isBusy || undefined}
      aria-label={props.label}
      title={props.title}
      onClick={() => void press()}
    >
      {props.children}
    </button>
  );
}

/** A button for actions that cannot be undone: it asks for a second press. Escape or 6 s without a press cancels. */
export function ConfirmButton(props: {
  children: ComponentChildren;
  sure: string;
  onPress: () => unknown;
  kind?: 'danger' | 'plain';
}) {
  const [isAsking, setAsking] = useState(false);
  useEffect(() => {
    if (!isAsking) return undefined;
    const timer = window.setTimeout(() => setAsking(false), 6000);
    return () => window.clearTimeout(timer);
  }, [isAsking]);
  const press = async () => {
    if (!isAsking) return setAsking(true);
    await props.onPress();
    setAsking(false);
  };
  return (
    <span
      class="careful"
      onKeyDown={(event) => {
        if (event.key === 'Escape') setAsking(false);
      }}
    >
      <Button kind={isAsking ? 'danger' : props.kind} onPress={press}>
        {isAsking ? props.sure : props.children}
      </Button>
    </span>
  );
}

/**
 * A number with its unit. The typed text is never changed. A number in range becomes the value. Any other text is marked
 * as an error, restores the value from before the edit, and blocks the form's action (`field_errors`).
 */
export function NumberField(props: {
  label: string;
  /** The field of the job, which the daemon may refuse. */
  field?: Field;
  /** The id of an error that is shown elsewhere. */
  errorId?: string | undefined;
  unit: string;
  value: number | undefined;
  onValue: (value: number) => void;
  /** Called when the field is cleared; if absent, an empty field is an error. */
  onEmpty?: () => void;
  min: number;
  max: number;
  digits?: number;
  step?: number;
  placeholder?: string;
  disabled?: boolean;
}) {
  const id = useId();
  // The text that the user typed. If undefined, the field shows the value.
  const [typed, setTyped] = useState<string>();
  const lastValue = useRef(props.value);
  const valueBefore = useRef(props.value);
  const isFocused = useRef(false);
  const shown =
    props.value === undefined ? '' : String(Number(props.value.toFixed(props.digits ?? 1)));
  const text = typed ?? shown;

  const read = (content: string): Result<number | undefined> =>
    props.onEmpty && content.trim() === '' ? done(undefined) : readNumber(content, props);
  const failure = typed === undefined ? undefined : failureOf(read(typed));
  useReportError(props.label, failure !== undefined);
  const refusal = useRefusal(props.field, props.value);
  const error = failure ? `${failure.what}. ${failure.remedy}.` : refusal;

  const tell = (value: number | undefined) => {
    if (value === lastValue.current) return;
    lastValue.current = value;
    if (value === undefined) props.onEmpty?.();
    else props.onValue(value);
  };
  const take = (content: string) => {
    setTyped(content);
    const number = read(content);
    tell(number.ok ? number.value : valueBefore.current);
  };
  // A value set from outside replaces the typed text, but not during typing.
  const follow = () => {
    if (isFocused.current && typed !== undefined) return;
    if (isSame(props.value, lastValue.current)) return;
    lastValue.current = props.value;
    setTyped(undefined);
  };
  // A layout effect runs before anything can be typed; after the first paint, it would remove what was typed before.
  useLayoutEffect(follow, [props.value]);
  const nudge = (event: KeyboardEvent) => {
    const step = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    const from = text.trim() === '' ? 0 : parseNumber(text);
    if (!step || from === undefined) return;
    event.preventDefault();
    const size = (props.step ?? 1) * (event.shiftKey ? 10 : 1);
    take(String(Number((from + step * size).toFixed(6))));
  };
  return (
    <div class="field">
      <label for={id}>{props.label}</label>
      <span class="with-unit">
        <input
          id={id}
          inputMode="decimal"
          autocomplete="off"
          value={text}
          placeholder={props.placeholder}
          disabled={props.disabled}
          {...invalidity(error ? errorIdOf(id) : props.errorId)}
          onFocus={() => {
            isFocused.current = true;
            valueBefore.current = lastValue.current;
          }}
          onInput={(event) => take(event.currentTarget.value)}
          onBlur={() => {
            isFocused.current = false;
            follow();
          }}
          onKeyDown={nudge}
        />
        <span class="unit">{props.unit}</span>
      </span>
      <FieldError id={id} error={error} />
    </div>
  );
}

const errorIdOf = (id: string) => `${id}-error`;

/** Attributes of an input with an error. */
const invalidity = (errorId: string | undefined) => ({
  'aria-invalid': errorId !== undefined,
  'aria-describedby': errorId,
});

/** The error of the input with this id, if there is one. An enclosing <details> opens to show it. */
function FieldError({ id, error }: { id: string; error: string | undefined }) {
  const text = useRef<HTMLSpanElement>(null);
  const hasError = error !== undefined;
  useLayoutEffect(() => text.current?.closest('details')?.setAttribute('open', ''), [hasError]);
  return hasError ? (
    <span class="error" id={errorIdOf(id)} role="alert" ref={text}>
      {error}
    </span>
  ) : null;
}

const failureOf = (result: Result<unknown>) => (result.ok ? undefined : result.failure);

/** True if equal up to rounding, which occurs when a value is converted to another unit and back. */
const isSame = (a: number | undefined, b: number | undefined): boolean =>
  a === b ||
  (a !== undefined && b !== undefined && Math.abs(a - b) <= 1e-6 * Math.max(1, Math.abs(b)));

export function TextField(props: {
  label: string;
  value: string;
  onValue: (value: string) => void;
  placeholder?: string;
  type?: string;
  autocomplete?: JSX.InputHTMLAttributes<HTMLInputElement>['autocomplete'];
  /** Longest text that can be typed, in bytes of UTF-8. */
  maxBytes?: number;
}) {
  const id = useId();
  const take = (input: HTMLInputElement) => {
    const text = cutToBytes(input.value, props.maxBytes ?? Infinity);
    if (text !== input.value) input.value = text;
    props.onValue(text);
  };
  return (
    <div class="field">
      <label for={id}>{props.label}</label>
      <input
        id={id}
        type={props.type ?? 'text'}
        value={props.value}
        placeholder={props.placeholder}
        autocomplete={props.autocomplete ?? 'off'}
        onInput={(event) => take(event.currentTarget)}
      />
    </div>
  );
}

export function Choice<T extends string>(props: {
  label: string;
  field?: Field;
  value: T;
  choices: readonly { value: T; label: string }[];
  onValue: (value: T) => void;
  disabled?: boolean;
}) {
  const id = useId();
  const error = useRefusal(props.field, props.value);
  return (
    <div class="field">
      <label for={id}>{props.label}</label>
      <select
        id={id}
        value={props.value}
        disabled={props.disabled}
        {...invalidity(error && errorIdOf(id))}
        onChange={(event) => props.onValue(event.currentTarget.value as T)}
      >
        {props.choices.map(({ value, label }) => (
          <option key={value} value={value} selected={value === props.value}>
            {label}
          </option>
        ))}
      </select>
      <FieldError id={id} error={error} />
    </div>
  );
}

/** A choice with all options visible. */
export function Switch<T extends string>(props: {
  label: string;
  value: T;
  choices: readonly { value: T; label: string }[];
  onValue: (value: T) => void;
}) {
  const name = useId();
  return (
    <fieldset class="switch">
      <legend class="hidden">{props.label}</legend>
      {props.choices.map(({ value, label }) => (
        <label key={value}>
          <input
            type="radio"
            name={name}
            checked={value === props.value}
            onChange={() => props.onValue(value)}
          />
          <span>{label}</span>
        </label>
      ))}
    </fieldset>
  );
}

export function Check(props: { label: string; value: boolean; onValue: (value: boolean) => void }) {
  return (
    <label class="check">
      <input
        type="checkbox"
        checked={props.value}
        onChange={(event) => props.onValue(event.currentTarget.checked)}
      />
      {props.label}
    </label>
  );
}

/** A name and a value; nothing is shown of a row that is not set. */
export type Row = readonly [string, ComponentChildren] | false | undefined;

/** A list of labelled figures. */
export const Figures = ({ rows }: { rows: readonly Row[] }) => (
  <dl class="figures">
    {rows.map(
      (row) =>
        row && (
          <div key={row[0]}>
            <dt>{row[0]}</dt>
            <dd>{row[1]}</dd>
          </div>
        ),
    )}
  </dl>
);

/** Without `share`, it moves but does not say how far the work is. */
export function Progress({ share, label }: { share: number | undefined; label: string }) {
  return <progress max={1} {...(share === undefined ? {} : { value: share })} aria-label={label} />;
}
