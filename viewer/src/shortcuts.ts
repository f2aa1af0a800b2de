/** Keys that do something once, beside those of navigation that are held down. */
export type Shortcuts = ReadonlyMap<string, () => void>;

interface HeldKeys {
  keyDown(code: string): boolean;
  keyUp(code: string): void;
}

function isField(target: EventTarget | null): boolean {
  return target instanceof HTMLInputElement || target instanceof HTMLSelectElement;
}

/** By `key` (what is written on it) where it is a sign, else by `code` (where it is). */
export function listenToKeys(shortcuts: Shortcuts, held: HeldKeys): void {
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (document.querySelector('dialog[open]') && event.key !== '?') return;
    if (isField(event.target) && event.key !== 'Escape') return;
    const onButton = event.target instanceof HTMLButtonElement;
    if (onButton && (event.key === ' ' || event.key === 'Enter')) return;
    const run = shortcuts.get(event.key) ?? shortcuts.get(event.code);
    if (run && !event.repeat) {
      run();
      event.preventDefault();
    } else if (held.keyDown(event.code)) {
      event.preventDefault();
    }
  });
  window.addEventListener('keyup', (event) => held.keyUp(event.code));
}
