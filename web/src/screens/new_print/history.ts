/** Steps that can be undone and redone. */
const kMostSteps = 200;

export class History<T> {
  private past: T[] = [];
  private future: T[] = [];
  private action: unknown;

  constructor(private now: T) {}

  get present(): T {
    return this.now;
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }

  get canRedo(): boolean {
    return this.future.length > 0;
  }

  /** Adds a state. States of the same action, such as a drag, are one step. */
  add(next: T, action: unknown): void {
    const isSameStep = action !== undefined && action === this.action;
    if (!isSameStep) this.past = [...this.past, this.now].slice(-kMostSteps);
    this.action = action;
    this.future = [];
    this.now = next;
  }

  /** Goes back one step; the present state if there is none. */
  undo(): T {
    const before = this.past.pop();
    if (before === undefined) return this.now;
    this.future.push(this.now);
    return this.goTo(before);
  }

  redo(): T {
    const after = this.future.pop();
    if (after === undefined) return this.now;
    this.past.push(this.now);
    return this.goTo(after);
  }

  private goTo(state: T): T {
    this.action = undefined;
    this.now = state;
    return state;
  }
}
