import { el, short } from './dom';
import { stagesOf } from './live_stages';
import type { Frame } from './protocol';

export interface LiveFigures {
  readonly done: number;
  readonly total: number;
  readonly points: number;
  readonly lateFrames: number;
  readonly framesPerSecond: number | null;
  readonly latencyMs: number | null;
  readonly score: number | null;
  readonly meanScore: number | null;
}

const shownFrames = 60;

function text(value: number | null, digits: number, unit: string): string {
  return value === null ? '–' : `${value.toFixed(digits)}${unit}`;
}

/** How the mapping goes, while it goes: times, figures, the camera's image. */
export class LiveStrip {
  readonly element: HTMLElement;
  private readonly bars = el('canvas', { role: 'img', 'aria-label': 'Times of recent frames' });
  private readonly keys = el('ul', { class: 'keys' });
  private readonly image = el('img', { alt: 'The newest camera image', hidden: true });
  private readonly figures = el('dl', { class: 'figures' });
  private readonly stageColors = new Map<string, number>();
  private frames: Frame[] = [];
  private imageUrl = '';

  constructor(private readonly periodMs: number) {
    this.element = el('section', { class: 'live-strip card', 'aria-label': 'Live mapping' },
      this.image, el('div', { class: 'times' }, this.bars, this.keys), this.figures);
    new ResizeObserver(() => this.draw()).observe(this.bars);
  }

  addFrame(frame: Frame): void {
    if (frame.status !== 'skipped') this.frames.push(frame);
    this.frames = this.frames.slice(-shownFrames);
    for (const { stage } of stagesOf(frame)) {
      if (this.stageColors.has(stage)) continue;
      this.stageColors.set(stage, this.stageColors.size % 7);
      const swatch = el('span', { class: 'swatch' });
      swatch.style.background = `var(--s${this.stageColors.get(stage)})`;
      this.keys.append(el('li', {}, swatch, stage));
    }
    this.draw();
  }

  clear(): void {
    this.frames = [];
    this.draw();
  }

  setImage(jpeg: Uint8Array<ArrayBuffer>): void {
    const before = this.imageUrl;
    this.imageUrl = URL.createObjectURL(new Blob([jpeg], { type: 'image/jpeg' }));
    this.image.src = this.imageUrl;
    this.image.hidden = false;
    if (before) URL.revokeObjectURL(before);
  }

  show(figures: LiveFigures): void {
    const { done, total } = figures;
    const rows: [string, string, boolean?][] = [
      ['Frame', total > 0 ? `${done} / ${total}` : String(done)],
      ['Points', short(figures.points)],
      ['Rate', text(figures.framesPerSecond, 1, ' /s')],
      ['Late', String(figures.lateFrames), figures.lateFrames > 0],
      ['To the screen', text(figures.latencyMs, 0, ' ms')],
      ['Score', `${text(figures.score, 1, '')} (mean ${text(figures.meanScore, 1, '')})`],
    ];
    this.figures.replaceChildren(...rows.map(([name, value, warn]) => el('div', {},
      el('dt', {}, name), el('dd', warn ? { class: 'warn' } : {}, value))));
  }

  draw(): void {
    const { bars } = this;
    const [w, h] = [bars.clientWidth, bars.clientHeight];
    if (w === 0) return;
    bars.width = w * devicePixelRatio;
    bars.height = h * devicePixelRatio;
    const context = bars.getContext('2d')!;
    context.scale(devicePixelRatio, devicePixelRatio);
    const style = getComputedStyle(document.documentElement);
    const color = (name: string) => style.getPropertyValue(name).trim();
    const longest = Math.max(1.3 * this.periodMs, ...this.frames.map((frame) =>
      stagesOf(frame).reduce((sum, { milliseconds }) => sum + milliseconds, 0)));
    const y = (milliseconds: number) => h - milliseconds / longest * (h - 4);
    const width = w / shownFrames;
    this.frames.forEach((frame, i) => {
      let from = 0;
      for (const { stage, milliseconds } of stagesOf(frame)) {
        context.fillStyle = color(`--s${this.stageColors.get(stage) ?? 6}`);
        const top = y(from + milliseconds);
        context.fillRect(i * width + 0.5, top, Math.max(1, width - 1), y(from) - top);
        from += milliseconds;
      }
    });
    context.strokeStyle = color('--late');
    context.setLineDash([5, 3]);
    context.beginPath();
    context.moveTo(0, y(this.periodMs));
    context.lineTo(w, y(this.periodMs));
    context.stroke();
    context.fillStyle = color('--ink-2');
    context.font = '11px system-ui, sans-serif';
    context.textAlign = 'right';
    context.fillText(`${Math.round(this.periodMs)} ms`, w - 2, y(this.periodMs) - 3);
  }
}
