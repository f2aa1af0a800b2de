import { Vector3 } from 'three';

import type { Trajectory } from '../trajectory';
import { flown, flyKeys, looked } from './fly';
import { Gestures } from './gestures';
import { depthOf, orbited, panned, zoomed } from './orbit';
import { between, forwardOf, type View } from './view';
import { chasing, walked, walkSpeed, walkStep } from './walk';

export type NavigationMode = 'orbit' | 'fly' | 'walk';

/** What navigation needs to know of the picture and tells of what the user did. */
export interface NavigationHost {
  probe(x: number, y: number): Vector3 | null;
  pixelsPerUnit(): number;
  trajectory: Trajectory;
  row(): number;
  setRow(row: number): void;
  changed(): void;
  /** The user moved the camera by hand. */
  moved(): void;
  click(x: number, y: number): void;
  doubleClick(x: number, y: number): void;
}

/** Who has the picture in hand while the camera stands fast. */
export interface Hands {
  pan(dx: number, dy: number): void;
  zoom(factor: number, x: number, y: number): void;
}

const flightSeconds = 0.7;
const chaseRate = 3.5;  // 1/s

function smooth(x: number): number {
  return x * x * (3 - 2 * x);
}

/** The camera under the user's hands: orbit, fly, walk, and flights from one view to another. */
export class Navigation {
  mode: NavigationMode = 'orbit';
  hands: Hands | null = null;
  private current: View = { eye: new Vector3(0, 0, 20), yaw: 0, pitch: -0.5 };
  private pivot = new Vector3();
  private turned = { yaw: 0, pitch: 0 };
  private flight: { from: View; to: View; at: number } | null = null;
  private readonly keys = new Set<string>();
  private speed = 8;
  private zoomTarget: { x: number; y: number; point: Vector3; at: number } | null = null;

  constructor(canvas: HTMLCanvasElement, private readonly host: NavigationHost) {
    new Gestures(canvas, {
      begin: (x, y) => this.begin(x, y),
      rotate: (dx, dy) => this.rotate(dx, dy),
      pan: (dx, dy) => this.pan(dx, dy),
      zoom: (factor, x, y) => this.zoom(factor, x, y),
      click: (x, y) => this.host.click(x, y),
      doubleClick: (x, y) => this.host.doubleClick(x, y),
    });
    window.addEventListener('blur', () => this.keys.clear());
  }

  get view(): View {
    return this.current;
  }

  get moving(): boolean {
    return this.flight !== null || this.keys.size > 0;
  }

  setView(view: View): void {
    this.flight = null;
    this.current = view;
    this.host.changed();
  }

  /** In a moment, or at once for those who asked for less motion. */
  flyTo(view: View): void {
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) return this.setView(view);
    this.flight = { from: this.current, to: view, at: 0 };
    this.host.changed();
  }

  /** Walking begins in the direction of the drive, or in that of `view`. */
  setMode(mode: NavigationMode, view: View | null = null): void {
    this.mode = mode;
    this.turned = view === null ? { yaw: 0, pitch: 0 } : {
      yaw: view.yaw - this.host.trajectory.heading(this.host.row()), pitch: view.pitch,
    };
    this.flight = null;
    this.host.changed();
  }

  /** Returns whether the key was one of navigation's. */
  keyDown(code: string): boolean {
    const shift = code.startsWith('Shift');
    if (!shift && !flyKeys.has(code)) return false;
    if (this.hands) return false;
    this.keys.add(code);
    this.host.changed();
    return !shift;
  }

  keyUp(code: string): void {
    this.keys.delete(code);
  }

  /** Nearer to what is under the cursor. */
  approach(x: number, y: number): void {
    const hit = this.hands || this.mode === 'walk' ? null : this.host.probe(x, y);
    if (!hit) return;
    this.host.moved();
    this.flyTo(zoomed(this.current, hit, 0.4));
  }

  /** One step in time. `follow`: stay behind the vehicle. */
  step(seconds: number, follow: boolean): void {
    const held = [...this.keys].some((key) => !key.startsWith('Shift'));
    if (this.flight) {
      this.flight.at = Math.min(1, this.flight.at + seconds / flightSeconds);
      this.current = between(this.flight.from, this.flight.to, smooth(this.flight.at));
      if (this.flight.at === 1) this.flight = null;
    }
    if (this.mode === 'walk') {
      if (held) this.host.setRow(this.host.row() + walkStep(this.keys) * walkSpeed * seconds);
      this.current = walked(this.host.trajectory, this.host.row(), this.turned, this.current);
      return;
    }
    if (held) {
      this.flight = null;
      this.host.moved();
      this.current = flown(this.current, this.keys, this.speed, seconds);
    } else if (follow && !this.flight) {
      const share = 1 - Math.exp(-chaseRate * seconds);
      const wanted = chasing(this.host.trajectory, this.host.row());
      this.current = between(this.current, wanted, share);
    }
  }

  /** How far the camera is from where it should be behind the vehicle (m). */
  distanceToChase(): number {
    return chasing(this.host.trajectory, this.host.row()).eye.distanceTo(this.current.eye);
  }

  private begin(x: number, y: number): void {
    if (this.hands) return;
    const hit = this.host.probe(x, y);
    if (hit) {
      this.pivot.copy(hit);
    } else {
      const depth = Math.min(60, depthOf(this.current, this.pivot));
      this.pivot.copy(this.current.eye).addScaledVector(forwardOf(this.current), depth);
    }
  }

  private rotate(dx: number, dy: number): void {
    if (this.hands) return this.hands.pan(dx, dy);
    this.flight = null;
    if (this.mode === 'orbit') {
      this.host.moved();
      this.current = orbited(this.current, this.pivot, -dx * 0.006, -dy * 0.006);
    } else if (this.mode === 'fly') {
      this.host.moved();
      this.current = looked(this.current, dx, dy, this.host.pixelsPerUnit());
    } else {
      const { yaw, pitch } = looked(
        { ...this.current, ...this.turned }, dx, dy, this.host.pixelsPerUnit());
      this.turned = { yaw, pitch };
    }
    this.host.changed();
  }

  private pan(dx: number, dy: number): void {
    if (this.hands) return this.hands.pan(dx, dy);
    if (this.mode === 'walk') return;
    this.flight = null;
    this.host.moved();
    const depth = depthOf(this.current, this.pivot);
    this.current = panned(this.current, depth, dx, dy, this.host.pixelsPerUnit());
    this.host.changed();
  }

  private zoom(factor: number, x: number, y: number): void {
    if (this.hands) return this.hands.zoom(factor, x, y);
    if (this.mode === 'walk') {
      this.host.setRow(this.host.row() - Math.log(factor) / 0.16);
      return;
    }
    this.flight = null;
    this.host.moved();
    this.current = zoomed(this.current, this.targetOfZoom(x, y), factor);
    this.host.changed();
  }

  /** The wheel turns in many small steps: they all go for the point that was there at first. */
  private targetOfZoom(x: number, y: number): Vector3 {
    const now = performance.now();
    const last = this.zoomTarget;
    if (last && now - last.at < 400 && Math.hypot(x - last.x, y - last.y) < 8) {
      last.at = now;
      return last.point;
    }
    this.begin(x, y);
    this.zoomTarget = { x, y, point: this.pivot.clone(), at: now };
    return this.zoomTarget.point;
  }
}
