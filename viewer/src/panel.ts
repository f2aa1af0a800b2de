import { Budget } from './budget';
import { colorModeTexts, modesOf, type ColorMode, type DataRanges } from './color_modes';
import { el, setPressed, short } from './dom';
import { legendOf } from './legend';
import type { MapInfo } from './protocol';
import { showsUncolored, type Settings } from './settings';
import type { Store } from './store';

type Toggle = keyof { [K in keyof Settings as Settings[K] extends boolean ? K : never]: true };

let fields = 0;

function row(label: string, input: HTMLElement, ...more: HTMLElement[]): HTMLElement {
  input.id = `field-${++fields}`;
  return el('div', { class: 'row' }, el('label', { for: input.id }, label), ...more, input);
}

/** The settings beside the map. */
export class Panel {
  readonly element: HTMLElement;
  private readonly modes = new Map<ColorMode, HTMLButtonElement>();
  private readonly legend = el('div');
  private readonly hint = el('p', { class: 'hint' });
  private readonly uncolored = el('input', { type: 'checkbox' });
  private readonly budgetSlider = el('input', {
    type: 'range', min: Math.log10(Budget.lowest), max: Math.log10(Budget.highest), step: 0.01,
  });
  private readonly automatic = el('input', { type: 'checkbox' });
  private readonly budgetText = el('output');

  /** `first`: a section above the settings. */
  constructor(private readonly map: MapInfo, private readonly settings: Store<Settings>,
              first: HTMLElement | null = null) {
    this.element = el('aside', { class: 'panel card', 'aria-label': 'What to show' },
      first, this.colors(), this.points(), this.extras());
    settings.listen((now) => this.show(now));
  }

  setLegend(ranges: DataRanges, cameras: ReadonlySet<number>): void {
    this.legend.replaceChildren(
      legendOf(this.settings.get().mode, this.map, ranges, cameras));
  }

  setBudget(points: number): void {
    this.budgetText.textContent = short(points);
    if (this.automatic.checked) this.budgetSlider.value = String(Math.log10(points));
  }

  private colors(): HTMLElement {
    const group = el('div', { class: 'modes', role: 'group', 'aria-label': 'Colours' });
    for (const mode of modesOf(this.map)) {
      const [name, title] = colorModeTexts[mode];
      const button = el('button', {
        type: 'button', title, onclick: () => this.settings.set({ mode }),
      }, name);
      this.modes.set(mode, button);
      group.append(button);
    }
    this.uncolored.addEventListener('change', () => {
      const shown = this.uncolored.checked;
      this.settings.set(this.settings.get().mode === 'photograph' ?
        { uncoloredInPhotograph: shown } : { uncoloredElsewhere: shown });
    });
    return el('section', {}, el('h2', {}, 'Colours'), group, this.hint, this.legend,
      ...this.ofPoints(() => [row('Points no camera saw', this.uncolored)]));
  }

  private points(): HTMLElement {
    this.automatic.addEventListener('change', () => this.settings.set({
      fixedBudget: this.automatic.checked ? null : 10 ** Number(this.budgetSlider.value),
    }));
    this.budgetSlider.addEventListener('input', () => {
      this.settings.set({ fixedBudget: Math.round(10 ** Number(this.budgetSlider.value)) });
    });
    const what = this.map.mesh ? 'Vertices' : 'Points';
    this.budgetSlider.setAttribute('aria-label', `${what} to draw at most`);
    return el('section', {}, el('h2', {}, what),
      row('As many as go well', this.automatic, this.budgetText),
      this.budgetSlider,
      ...this.ofPoints(() => [this.slider('Splat size', 'splatSize', 0.4, 3)]),
      row('Eye-dome lighting', this.toggle('eyeDome')),
      this.slider('Strength', 'eyeDomeStrength', 0.1, 1.5),
      ...this.ofPoints(() => [row('Sharp seams between splats', this.toggle('paraboloids'))]));
  }

  private extras(): HTMLElement {
    const title = el('h2', {}, 'Also show');
    const trajectory = row('Trajectory and vehicle', this.toggle('trajectory'));
    if (this.map.city) return el('section', {}, title, trajectory);  // its points have no frames
    return el('section', {}, title, trajectory,
      row('Foveal region of the frame', this.toggle('foveal')),
      ...this.ofPoints(() => [row('Rays to its points', this.toggle('rays'))]));
  }

  /** What there is to set of points alone. */
  private ofPoints(rows: () => HTMLElement[]): HTMLElement[] {
    return this.map.mesh ? [] : rows();
  }

  private slider(label: string, key: 'splatSize' | 'eyeDomeStrength', min: number,
                 max: number): HTMLElement {
    const input = el('input', { type: 'range', min, max, step: 0.05 });
    const output = el('output');
    input.addEventListener('input', () => this.settings.set({ [key]: Number(input.value) }));
    this.settings.listen((now) => {
      input.value = String(now[key]);
      output.textContent = now[key].toFixed(2);
    });
    input.id = `field-${++fields}`;
    return el('div', { class: 'field' }, el('div', { class: 'row' },
      el('label', { for: input.id }, label), output), input);
  }

  private toggle(key: Toggle): HTMLInputElement {
    const input = el('input', { type: 'checkbox' });
    input.addEventListener('change', () => this.settings.set({ [key]: input.checked }));
    this.settings.listen((now) => { input.checked = now[key]; });
    return input;
  }

  private show(now: Settings): void {
    for (const [mode, button] of this.modes) {
      setPressed(button, mode === now.mode);
    }
    this.hint.textContent = colorModeTexts[now.mode][1];
    this.uncolored.checked = showsUncolored(now);
    this.automatic.checked = now.fixedBudget === null;
    if (now.fixedBudget !== null) {
      this.budgetSlider.value = String(Math.log10(now.fixedBudget));
    }
  }
}
