import { el, iconButton, setPressed } from './dom';
import { icon } from './icons';
import type { Trajectory } from './trajectory';

export interface TimelineEvents {
  setRow(row: number): void;
  setPlaying(playing: boolean): void;
  setFollow(follow: boolean): void;
}

const speeds = [0.25, 0.5, 1, 2, 5, 10];

/** The drive's frames from left to right: play, scrub, jump. */
export class Timeline {
  readonly element: HTMLElement;
  speed = 1;
  private readonly play: HTMLButtonElement;
  private readonly follow: HTMLButtonElement;
  private readonly scrubber = el('input', {
    type: 'range', min: 0, max: 0, step: 'any', value: 0, 'aria-label': 'Frame of the drive',
  });
  private readonly number = el('input', {
    type: 'number', step: 1, 'aria-label': 'Frame number', title: 'Frame number',
  });
  private readonly clock = el('span', { class: 'clock', title: 'Since the first frame' });
  private readonly canvas = el('canvas', { 'aria-hidden': 'true' });
  private playing = false;

  constructor(private readonly trajectory: Trajectory, events: TimelineEvents) {
    this.play = iconButton(icon('play'), 'Play the drive (Space)',
      () => events.setPlaying(!this.playing));
    this.follow = iconButton(icon('follow'), 'Follow the vehicle (C)',
      () => events.setFollow(this.follow.getAttribute('aria-pressed') !== 'true'));
    const speed = el('select', { 'aria-label': 'Speed', title: 'Speed', class: 'speed' },
      ...speeds.map((value) => el('option', { value, selected: value === 1 }, `${value}×`)));
    speed.addEventListener('change', () => { this.speed = Number(speed.value); });
    this.scrubber.addEventListener('input', () => events.setRow(Number(this.scrubber.value)));
    this.number.addEventListener('change', () => {
      events.setRow(this.trajectory.nearestRow(Number(this.number.value)));
    });
    this.element = el('div', { class: 'timeline card', role: 'group', 'aria-label': 'Timeline' },
      this.play, speed,
      el('div', { class: 'track' }, this.canvas, this.scrubber), this.number, this.clock,
      this.follow);
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  setPlaying(playing: boolean): void {
    this.playing = playing;
    this.play.replaceChildren(icon(playing ? 'pause' : 'play'));
    setPressed(this.play, playing);
  }

  setFollow(follow: boolean): void {
    setPressed(this.follow, follow);
  }

  /** The frames have changed. */
  update(): void {
    const { length } = this.trajectory;
    this.element.hidden = length === 0;
    this.scrubber.max = String(Math.max(length - 1, 0));
    this.number.min = String(this.trajectory.frame(0)?.index ?? 0);
    this.number.max = String(this.trajectory.frame(length - 1)?.index ?? 0);
    this.draw();
  }

  show(row: number): void {
    this.scrubber.value = String(row);
    const frame = this.trajectory.frame(Math.round(row));
    if (!frame) return;
    if (document.activeElement !== this.number) this.number.value = String(frame.index);
    this.scrubber.setAttribute('aria-valuetext', `frame ${frame.index}, ${frame.status}`);
    this.clock.textContent = frame.time === null ? '' : `${frame.time.toFixed(1)} s`;
  }

  /** A tick a frame: held-out ones stand out, skipped ones are gaps; a line of scores. */
  draw(): void {
    const { canvas, trajectory } = this;
    const ratio = devicePixelRatio;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (w === 0 || trajectory.length === 0) return;
    canvas.width = w * ratio;
    canvas.height = h * ratio;
    const context = canvas.getContext('2d')!;
    context.scale(ratio, ratio);
    const style = getComputedStyle(document.documentElement);
    const color = (name: string) => style.getPropertyValue(name).trim();
    const colors = { mapped: color('--s0'), 'held-out': color('--s2'), skipped: color('--line') };
    const last = Math.max(trajectory.length - 1, 1);
    const x = (row: number) => 1.5 + row / last * (w - 3);
    const width = Math.max(1, Math.min(4, 0.6 * w / trajectory.length));
    const scores = trajectory.all().map(({ score }) => score);
    const highest = Math.max(1, ...scores.map((score) => score ?? 0));
    trajectory.all().forEach(({ status }, row) => {
      context.fillStyle = colors[status];
      context.globalAlpha = status === 'mapped' ? 0.55 : 1;
      context.fillRect(x(row) - width / 2, h - 10, width, 10);
    });
    context.globalAlpha = 1;
    context.strokeStyle = color('--ink-3');
    context.beginPath();
    let drawing = false;
    scores.forEach((score, row) => {
      if (score === null) {
        drawing = false;
        return;
      }
      const y = h - 12 - score / highest * (h - 15);
      if (drawing) context.lineTo(x(row), y);
      else context.moveTo(x(row), y);
      drawing = true;
    });
    context.stroke();
  }
}
