/** Parts of the page whose code is loaded after that of the first screen. */
import type { ComponentType } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { beginnings } from '../events';

/** A component whose code is loaded when it is shown. After a failure it is loaded again once the daemon answers. */
export function later<P extends object>(load: () => Promise<ComponentType<P>>): ComponentType<P> {
  let Loaded: ComponentType<P> | undefined;
  return (props: P) => {
    const [state, setState] = useState<'loading' | 'loaded' | 'failed'>('loading');
    useEffect(() => {
      if (Loaded) return;
      void load().then(
        (part) => {
          Loaded = part;
          setState('loaded');
        },
        () => setState('failed'),
      );
    }, [beginnings.value]);
    if (Loaded) return <Loaded {...props} />;
    if (state === 'failed')
      return (
        <p class="warning" role="alert">
          This part of the page could not be loaded. Reload the page.
        </p>
      );
    return <p class="quiet">Loading…</p>;
  };
}
