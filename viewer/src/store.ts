/** A value that tells its listeners when it changes. */
export class Store<T extends object> {
  private value: T;
  private readonly listeners = new Set<(value: T, before: T) => void>();

  constructor(initial: T) {
    this.value = initial;
  }

  get(): T {
    return this.value;
  }

  set(change: Partial<T>): void {
    const before = this.value;
    const keys = Object.keys(change) as (keyof T)[];
    if (keys.every((key) => Object.is(before[key], change[key]))) return;
    this.value = { ...before, ...change };
    for (const listener of this.listeners) listener(this.value, before);
  }

  /** Calls at once, and at every change from then on. */
  listen(listener: (value: T, before: T) => void): void {
    this.listeners.add(listener);
    listener(this.value, this.value);
  }
}
