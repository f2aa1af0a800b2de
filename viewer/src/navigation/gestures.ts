/** What fingers, mouse and wheel mean, in CSS pixels from the canvas' upper left corner. */
export interface GestureEvents {
  /** A drag begins: what is under the cursor matters from now on. */
  begin(x: number, y: number): void;
  rotate(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  /** `factor` below 1: nearer. */
  zoom(factor: number, x: number, y: number): void;
  click(x: number, y: number): void;
  doubleClick(x: number, y: number): void;
}

interface Finger {
  x: number;
  y: number;
}

const clickReach = 5;
const clickTime = 500;
const doubleClickTime = 320;

export class Gestures {
  private readonly fingers = new Map<number, Finger>();
  private start: Finger & { time: number } | null = null;
  private lastClick: Finger & { time: number } | null = null;
  private panning = false;
  private spread = 0;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly events: GestureEvents) {
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.up(event, true));
    canvas.addEventListener('pointercancel', (event) => this.up(event, false));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
  }

  private place(event: MouseEvent): Finger {
    const box = this.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private down(event: PointerEvent): void {
    const at = this.place(event);
    this.canvas.setPointerCapture(event.pointerId);
    if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
    this.fingers.set(event.pointerId, at);
    if (this.fingers.size === 1) {
      this.start = { ...at, time: event.timeStamp };
      this.panning = event.button !== 0 || event.shiftKey || event.ctrlKey;
      this.events.begin(at.x, at.y);
    } else {
      this.start = null;
      const { middle, spread } = this.pair();
      this.spread = spread;
      this.events.begin(middle.x, middle.y);
    }
  }

  private move(event: PointerEvent): void {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const at = this.place(event);
    if (this.fingers.size === 1) {
      this.fingers.set(event.pointerId, at);
      if (this.start && Math.hypot(at.x - this.start.x, at.y - this.start.y) > clickReach) {
        this.start = null;
      }
      if (this.start) {
        this.fingers.set(event.pointerId, before);
        return;
      }
      const [dx, dy] = [at.x - before.x, at.y - before.y];
      if (this.panning) this.events.pan(dx, dy);
      else this.events.rotate(dx, dy);
      return;
    }
    const old = this.pair();
    this.fingers.set(event.pointerId, at);
    const { middle, spread } = this.pair();
    this.events.pan(middle.x - old.middle.x, middle.y - old.middle.y);
    if (spread > 1 && this.spread > 1) {
      this.events.zoom(this.spread / spread, middle.x, middle.y);
    }
    this.spread = spread;
  }

  private pair(): { middle: Finger; spread: number } {
    const [a, b] = [...this.fingers.values()] as [Finger, Finger];
    return {
      middle: { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 },
      spread: Math.hypot(a.x - b.x, a.y - b.y),
    };
  }

  private up(event: PointerEvent, meant: boolean): void {
    this.fingers.delete(event.pointerId);
    const { start } = this;
    this.start = null;
    if (!meant || !start || event.timeStamp - start.time > clickTime || this.panning) return;
    const last = this.lastClick;
    const double = last !== null && event.timeStamp - last.time < doubleClickTime &&
      Math.hypot(start.x - last.x, start.y - last.y) < 2 * clickReach;
    this.lastClick = double ? null : { x: start.x, y: start.y, time: event.timeStamp };
    if (double) this.events.doubleClick(start.x, start.y);
    else this.events.click(start.x, start.y);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const { x, y } = this.place(event);
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
    const step = Math.max(-240, Math.min(240, event.deltaY * lines));
    this.events.zoom(Math.exp(step * 0.0016), x, y);
  }
}
