import { el } from './dom';

export interface Notice {
  readonly text: string;
  /** Good to know, rather than something that went wrong. */
  readonly calm?: boolean;
  /** 0 to 1 draws a bar. */
  readonly progress?: number;
  readonly action?: { readonly label: string; readonly run: () => void };
}

/** What the user must know, each matter once: a later word on it replaces the earlier. */
export class Notices {
  readonly element = el('div', { class: 'notices', role: 'status', 'aria-live': 'polite' });
  private readonly shown = new Map<string, { element: HTMLElement; timer: number }>();

  /** With `seconds` it goes by itself. */
  show(matter: string, notice: Notice, seconds = 0): void {
    this.clear(matter);
    const { text, progress, action, calm } = notice;
    const element = el('div', { class: calm ? 'notice calm' : 'notice' }, el('span', {}, text),
      action ? el('button', { type: 'button', class: 'text', onclick: action.run }, action.label) :
        null,
      progress === undefined ? null :
        el('progress', { max: 1, value: progress, 'aria-label': text }),
      el('button', {
        type: 'button', class: 'close', 'aria-label': 'Dismiss', onclick: () => this.clear(matter),
      }, '×'));
    const timer = seconds > 0 ? window.setTimeout(() => this.clear(matter), 1000 * seconds) : 0;
    this.shown.set(matter, { element, timer });
    this.element.append(element);
  }

  clear(matter: string): void {
    const known = this.shown.get(matter);
    if (!known) return;
    clearTimeout(known.timer);
    known.element.remove();
    this.shown.delete(matter);
  }
}

/** In place of the map, where there is none to show. */
export function showInstead(root: HTMLElement, title: string, text: string,
                            action?: { label: string; run: () => void }): void {
  root.replaceChildren(el('main', { class: 'instead' },
    el('h1', {}, title), el('p', {}, text),
    action ? el('button', { type: 'button', class: 'primary', onclick: action.run }, action.label) :
      null));
}
