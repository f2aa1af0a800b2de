import { Color } from 'three';

export type Theme = 'dark' | 'light';

const key = 'fovea-theme';

/** Storage may be forbidden to a page; then the choice lasts as long as the page. */
function remembered(): Theme | null {
  try {
    const value = localStorage.getItem(key);
    return value === 'dark' || value === 'light' ? value : null;
  } catch {
    return null;
  }
}

function remember(theme: Theme): void {
  try {
    localStorage.setItem(key, theme);
  } catch {
    // not remembered, no harm
  }
}

/** Dark or light: the user's choice, else the system's. */
export class ThemeChoice {
  private chosen = remembered();
  private readonly system = matchMedia('(prefers-color-scheme: dark)');

  constructor(private readonly changed: (theme: Theme) => void) {
    this.system.addEventListener('change', () => this.apply());
    this.apply();
  }

  get theme(): Theme {
    return this.chosen ?? (this.system.matches ? 'dark' : 'light');
  }

  toggle(): void {
    this.chosen = this.theme === 'dark' ? 'light' : 'dark';
    remember(this.chosen);
    this.apply();
  }

  private apply(): void {
    document.documentElement.dataset.theme = this.theme;
    this.changed(this.theme);
  }
}

/** The sky of the picture: above and below. */
export function backgroundOf(theme: Theme): readonly [Color, Color] {
  return theme === 'dark' ? [new Color(0x161a21), new Color(0x0b0d10)] :
    [new Color(0xdfe5ec), new Color(0xf6f6f3)];
}
