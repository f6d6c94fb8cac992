/** Short notices on the page: failures with their remedy, and confirmations. */
import { signal } from '@preact/signals';
import type { Failure, Result } from '../model/result';

export interface Notice {
  id: number;
  kind: 'failure' | 'done';
  what: string;
  remedy?: string;
}

export const notices = signal<Notice[]>([]);
let count = 0;

function add(notice: Omit<Notice, 'id'>): void {
  count += 1;
  const id = count;
  const others = notices.value.filter((n) => n.what !== notice.what);
  notices.value = [...others.slice(-3), { ...notice, id }];
  if (notice.kind === 'done') window.setTimeout(() => dismiss(id), 5000);
}

export const dismiss = (id: number): void => {
  notices.value = notices.value.filter((notice) => notice.id !== id);
};

export const say = (what: string): void => add({ kind: 'done', what });

export const complain = ({ what, remedy }: Failure): void =>
  add({ kind: 'failure', what, ...(remedy ? { remedy } : {}) });

/** Returns the value. A failure is shown as a notice, and undefined is returned. */
export function orNotify<T>(result: Result<T>): T | undefined {
  if (result.ok) return result.value;
  complain(result.failure);
  return undefined;
}
