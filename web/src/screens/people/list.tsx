import type { ComponentChildren } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import type { Answer } from '../../api/services';
import type { Failure } from '../../model/result';

/** Fetches a list from the daemon; `again` fetches it once more. */
export function useFetched<T>(ask: () => Answer<T>): {
  value: T | undefined;
  failure: Failure | undefined;
  again: () => Promise<void>;
} {
  const [value, setValue] = useState<T>();
  const [failure, setFailure] = useState<Failure>();
  const again = async () => {
    const answer = await ask();
    if (answer.ok) setValue(answer.value);
    setFailure(answer.ok ? undefined : answer.failure);
  };
  useEffect(() => void again(), []);
  return { value, failure, again };
}

export function List(props: {
  heads: readonly string[];
  failure: Failure | undefined;
  /** Undefined until the list has been fetched. */
  count: number | undefined;
  empty: string;
  children: ComponentChildren;
}) {
  if (props.failure)
    return (
      <p class="warning" role="alert">
        {props.failure.what}
      </p>
    );
  if (props.count === undefined) return <p class="quiet">Loading…</p>;
  if (props.count === 0) return <p class="quiet">{props.empty}</p>;
  return (
    <table>
      <thead>
        <tr>
          {props.heads.map((head) => (
            <th scope="col" key={head}>
              {head || <span class="hidden">Actions</span>}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>{props.children}</tbody>
    </table>
  );
}

/** A secret that is shown only once: a key or a link. */
export function Once({ title, secret }: { title: string; secret: string }) {
  const [isCopied, setCopied] = useState(false);
  const copy = async () => {
    // The clipboard exists only if the page was loaded over TLS or from this machine.
    await navigator.clipboard?.writeText(secret).then(
      () => setCopied(true),
      () => setCopied(false),
    );
  };
  return (
    <div class="once" role="status">
      <p>{title}</p>
      <code>{secret}</code>
      <button type="button" onClick={() => void copy()}>
        {isCopied ? 'Copied' : 'Copy'}
      </button>
    </div>
  );
}

/** "ann" for "users/ann". */
export const plainName = (name: string): string => name.replace(/^\w+\//, '');
