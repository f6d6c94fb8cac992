/** The current route of the page, such as "#/jobs/7". */
import { computed, signal } from '@preact/signals';

const read = (): string => location.hash.replace(/^#/, '') || '/';
const hash = signal(typeof location === 'undefined' ? '/' : read());

if (typeof window !== 'undefined')
  window.addEventListener('hashchange', () => {
    hash.value = read();
    window.scrollTo(0, 0);
  });

/** The segments of the path, and the query. */
export const route = computed(() => {
  const [path = '', query = ''] = hash.value.split('?');
  return { parts: path.split('/').filter(Boolean), query: new URLSearchParams(query) };
});

export const go = (path: string): void => {
  location.hash = path;
};

/** The URL of a job's screen. */
export const jobPath = (name: string): string => `#/${name}`;

/** The URL of a new print that begins with a job's choices. */
export const againPath = (name: string): string => `#/?from=${name}`;
