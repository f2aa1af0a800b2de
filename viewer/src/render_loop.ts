/** Draws when something has changed, and on as long as something moves. */
export class RenderLoop {
  private requested = 0;
  private last: number | null = null;

  /**
   * `step` gets the seconds since the last frame, or null after a pause, and returns whether the
   * next frame shall follow without one.
   */
  constructor(private readonly step: (seconds: number | null) => boolean) {}

  invalidate(): void {
    if (this.requested === 0) this.requested = requestAnimationFrame((now) => this.frame(now));
  }

  /** Whether no frame is to come. */
  get idle(): boolean {
    return this.requested <= 0;
  }

  stop(): void {
    cancelAnimationFrame(this.requested);
    this.requested = -1;
  }

  private frame(now: number): void {
    if (this.requested === -1) return;
    this.requested = 0;
    const seconds = this.last === null ? null : (now - this.last) / 1000;
    this.last = now;
    const on = this.step(seconds);
    if (on) this.invalidate();
    else if (this.requested === 0) this.last = null;
  }
}
