import { Matrix4 } from 'three';

import { el, iconButton } from './dom';
import { icon } from './icons';
import { fitted, projectionOf, type Rectangle } from './intrinsics';
import { far, near } from './map_scene';
import { viewOfCamera } from './pose';
import type { CameraInfo, MapInfo } from './protocol';
import { imagePath, whyNoImage } from './server';
import type { Trajectory } from './trajectory';

export interface FrameViewEvents {
  changed(): void;
  close(): void;
  step(frames: number): void;
}

/** The map as a frame's camera saw it, and the photograph over it: left of a divider the one,
 * right the other. */
export class FrameView {
  readonly element: HTMLElement;
  private readonly image = el('img', { alt: 'Photograph of the frame', draggable: 'false' });
  private readonly picture: HTMLElement;
  private readonly missing = el('p', { class: 'no-image', role: 'status' });
  private readonly shade = el('div', { class: 'shade' });
  private readonly divider = el('div', { class: 'divider' });
  private readonly slider = el('input', {
    type: 'range', min: 0, max: 100, step: 1, value: 50, class: 'visually-hidden',
    'aria-label': 'Photograph on the left of, map on the right',
  });
  private readonly caption = el('span', { class: 'caption' });
  private readonly select = el('select', { 'aria-label': 'Camera' });
  private chosen: CameraInfo | null = null;
  private row = 0;
  private cut = 0.5;
  private zoom = { scale: 1, x: 0, y: 0 };
  private rectangle: Rectangle = { x: 0, y: 0, width: 1, height: 1 };
  private path = '';

  constructor(private readonly map: MapInfo, private readonly trajectory: Trajectory,
              private readonly events: FrameViewEvents) {
    this.picture = el('div', { class: 'photograph' }, this.image);
    this.select.append(...map.cameras.map(({ index }) =>
      el('option', { value: index }, `Camera ${index}`)));
    this.select.addEventListener('change', () => this.open(this.row, Number(this.select.value)));
    const bar = el('div', { class: 'frame-bar card' },
      iconButton(icon('previous'), 'Previous frame (,)', () => events.step(-1)),
      this.caption, this.select,
      iconButton(icon('next'), 'Next frame (.)', () => events.step(1)),
      iconButton(icon('close'), 'Leave the frame (Esc)', () => events.close()));
    this.element = el('div', { class: 'frame-view', hidden: true },
      this.shade, this.picture, this.missing, this.divider, bar, this.slider);
    this.slider.addEventListener('input', () => this.setCut(Number(this.slider.value) / 100));
    this.image.addEventListener('load', () => this.element.classList.add('has-image'));
    this.image.addEventListener('error', () => {
      this.element.classList.remove('has-image');
      if (this.path !== '') void this.sayWhyMissing(this.path);
    });
    this.dragDivider();
  }

  get active(): boolean {
    return this.chosen !== null;
  }

  get camera(): CameraInfo | null {
    return this.chosen;
  }

  open(row: number, camera: number | null): void {
    const found = this.map.cameras.find(({ index }) => index === camera) ??
      this.chosen ?? this.map.cameras[0];
    const frame = this.trajectory.frame(row);
    if (!found || !frame) return;
    if (!this.chosen) this.zoom = { scale: 1, x: 0, y: 0 };
    this.chosen = found;
    this.row = row;
    this.element.hidden = false;
    this.select.value = String(found.index);
    this.caption.textContent = `Frame ${frame.index}` +
      (frame.status === 'mapped' ? '' : `, ${frame.status}`);
    const path = this.map.images ? imagePath(frame.index, found.index) : '';
    if (path !== this.path) {
      this.path = path;
      this.element.classList.toggle('has-image', false);
      this.missing.textContent = '';
      if (path === '') this.image.removeAttribute('src');
      else this.image.src = path;
    }
    this.events.changed();
  }

  close(): void {
    this.chosen = null;
    this.element.hidden = true;
  }

  /** T_local_view of the chosen camera. */
  pose(): Matrix4 {
    return viewOfCamera(this.trajectory.pose(this.row)!, this.chosen!.T_cam_lidar);
  }

  /** For a window of this size, with the image in `area` of it; lays the photograph there too. */
  projection(width: number, height: number, area: Rectangle): Matrix4 {
    const camera = this.chosen!;
    const whole = fitted(camera.width, camera.height, area);
    const { scale, x, y } = this.zoom;
    this.rectangle = {
      x: Math.round(whole.x + whole.width / 2 * (1 - scale) + x),
      y: Math.round(whole.y + whole.height / 2 * (1 - scale) + y),
      width: Math.round(whole.width * scale),
      height: Math.round(whole.height * scale),
    };
    this.lay();
    return projectionOf(camera, this.rectangle, width, height, near, far);
  }

  pan(dx: number, dy: number): void {
    this.zoom = { ...this.zoom, x: this.zoom.x + dx, y: this.zoom.y + dy };
    this.events.changed();
  }

  /** The pixel at `x`, `y` stays where it is. */
  magnify(factor: number, x: number, y: number): void {
    const scale = Math.min(40, Math.max(1, this.zoom.scale * factor));
    const grown = scale / this.zoom.scale;
    const r = this.rectangle;
    const middle = { x: r.x + r.width / 2, y: r.y + r.height / 2 };
    this.zoom = scale === 1 ? { scale, x: 0, y: 0 } : {
      scale,
      x: this.zoom.x + (x - middle.x) * (1 - grown),
      y: this.zoom.y + (y - middle.y) * (1 - grown),
    };
    this.events.changed();
  }

  setCut(share: number): void {
    this.cut = Math.min(1, Math.max(0, share));
    this.slider.value = String(Math.round(100 * this.cut));
    this.lay();
  }

  private async sayWhyMissing(path: string): Promise<void> {
    const why = await whyNoImage(path);
    if (path === this.path) this.missing.textContent = why;
  }

  private lay(): void {
    const { x, y, width, height } = this.rectangle;
    const box = { left: `${x}px`, top: `${y}px`, width: `${width}px`, height: `${height}px` };
    Object.assign(this.shade.style, box);
    Object.assign(this.picture.style, box);
    Object.assign(this.missing.style, { left: `${x + width / 2}px`, top: `${y + height / 2}px` });
    this.picture.style.clipPath = `inset(0 ${100 * (1 - this.cut)}% 0 0)`;
    Object.assign(this.divider.style, {
      left: `${x + this.cut * width}px`, top: `${y}px`, height: `${height}px`,
    });
  }

  private dragDivider(): void {
    const { divider } = this;
    divider.addEventListener('pointerdown', (event) => {
      divider.setPointerCapture(event.pointerId);
      this.slider.focus({ preventScroll: true });
      event.preventDefault();
    });
    divider.addEventListener('pointermove', (event) => {
      if (!divider.hasPointerCapture(event.pointerId)) return;
      const left = this.element.getBoundingClientRect().left;
      this.setCut((event.clientX - left - this.rectangle.x) / this.rectangle.width);
    });
  }
}
