type Attributes = Record<string, string | number | boolean | ((event: never) => void)>;
type Child = Node | string | null;

/** An element: attributes, listeners (`onclick: f`) and children. */
export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') {
      element.addEventListener(name.slice(2), value as unknown as EventListener);
    } else if (typeof value === 'boolean') {
      element.toggleAttribute(name, value);
    } else {
      element.setAttribute(name, String(value));
    }
  }
  for (const child of children) if (child !== null) element.append(child);
  return element;
}

/** 6,360,000 as 6.36 M. */
export function short(count: number): string {
  if (count >= 1e9) return `${(count / 1e9).toFixed(2)} G`;
  if (count >= 1e6) return `${(count / 1e6).toFixed(2)} M`;
  if (count >= 1e4) return `${Math.round(count / 1e3)} k`;
  return String(Math.round(count));
}

/** A button that is only a picture: its label is for the tooltip and for screen readers. */
export function iconButton(picture: SVGElement, label: string, run: () => void,
                           attributes: Attributes = {}): HTMLButtonElement {
  return el('button', {
    type: 'button', class: 'icon', title: label, 'aria-label': label, onclick: run, ...attributes,
  }, picture);
}

export function setPressed(button: HTMLElement, pressed: boolean): void {
  button.setAttribute('aria-pressed', String(pressed));
}
