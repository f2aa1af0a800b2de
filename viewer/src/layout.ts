import { el, iconButton, setPressed } from './dom';
import { icon, type IconName } from './icons';
import type { NavigationMode } from './navigation/navigation';
import type { MapInfo } from './protocol';

export interface ToolbarEvents {
  navigate(mode: NavigationMode): void;
  frameView(): void;
  measure(): void;
  copyLink(): void;
  saveImage(): void;
  theme(): void;
  fullScreen(): void;
  help(): void;
  panel(): void;
}

const navigations: readonly (readonly [NavigationMode, IconName, string])[] = [
  ['orbit', 'orbit', 'Orbit (1)'], ['fly', 'fly', 'Fly (2)'],
  ['walk', 'walk', 'Walk along the drive (3)'],
];

/** Name of the map and the buttons above it. */
export class TopBar {
  readonly element: HTMLElement;
  private readonly figures = el('p');
  private readonly modes = new Map<NavigationMode, HTMLButtonElement>();
  private readonly frame: HTMLButtonElement;
  private readonly measure: HTMLButtonElement;
  private readonly panel: HTMLButtonElement;

  constructor(map: MapInfo, events: ToolbarEvents) {
    for (const [mode, name, label] of navigations) {
      this.modes.set(mode, iconButton(icon(name), label, () => events.navigate(mode)));
    }
    this.frame = iconButton(icon('frame'), 'Look from the frame (I)', events.frameView);
    this.measure = iconButton(icon('measure'), 'Measure (M)', events.measure);
    this.panel = iconButton(icon('panel'), 'Settings (H)', events.panel);
    const full = iconButton(icon('full'), 'Full screen', events.fullScreen,
      { hidden: !document.fullscreenEnabled });
    const toolbar = el('div', { class: 'toolbar card', role: 'toolbar', 'aria-label': 'Tools' },
      ...this.modes.values(), el('hr'), this.frame, this.measure, el('hr'),
      iconButton(icon('link'), 'Copy a link to this view', events.copyLink),
      iconButton(icon('picture'), 'Save the picture (P)', events.saveImage),
      iconButton(icon('theme'), 'Dark or light (T)', events.theme), full,
      iconButton(icon('help'), 'Keys and gestures (?)', events.help), el('hr'), this.panel);
    this.element = el('header', { class: 'top' },
      el('div', { class: 'title card' },
        el('h1', map.live ? { class: 'live-dot' } : {}, map.name), this.figures),
      toolbar);
  }

  setFigures(text: string): void {
    this.figures.textContent = text;
  }

  setLive(live: boolean): void {
    this.element.querySelector('h1')!.classList.toggle('live-dot', live);
  }

  show(navigation: NavigationMode, inFrame: boolean, measuring: boolean, panel: boolean): void {
    for (const [mode, button] of this.modes) setPressed(button, mode === navigation && !inFrame);
    setPressed(this.frame, inFrame);
    setPressed(this.measure, measuring);
    setPressed(this.panel, panel);
  }
}
