/** How many points to draw: as many as go smoothly, and more of them once the picture rests. */
export class Budget {
  static readonly lowest = 100_000;
  static readonly highest = 8_000_000;
  private static readonly start = 300_000;
  /** Frames to look at before each step. */
  private static readonly window = 8;
  private static readonly slow = 25;
  private static readonly quick = 50;
  /** A picture that rests may take longer. */
  private static readonly restFactor = 4;

  private adapted = Budget.start;
  private fixed: number | null = null;
  private intervals: number[] = [];
  private rate = 0;
  private resting = false;

  get points(): number {
    if (this.fixed !== null) return this.fixed;
    return this.resting ? Math.min(Budget.highest, Budget.restFactor * this.adapted) :
      this.adapted;
  }

  get atRest(): boolean {
    return this.resting;
  }

  /** Nothing moves any more: quality before speed. */
  rest(): void {
    this.resting = true;
  }

  /** Something moves again: speed before quality. */
  wake(): void {
    this.resting = false;
  }

  /** Frames per second of late, 0 before the first. */
  get fps(): number {
    return this.rate;
  }

  fix(points: number | null): void {
    this.fixed = points === null ? null :
      Math.min(Budget.highest, Math.max(Budget.lowest, Math.round(points)));
    this.intervals = [];
  }

  /** Whether drawing on would tell if more points are possible. */
  get mayGrow(): boolean {
    return this.fixed === null && !this.resting && this.adapted < Budget.highest &&
      (this.intervals.length < Budget.window || this.rate > Budget.quick);
  }

  /**
   * Takes note of a frame that followed another without a pause. `limited`: there are more points
   * to draw than the budget allows. Returns whether the budget has changed.
   */
  frame(milliseconds: number, limited: boolean): boolean {
    if (this.resting) return false;
    this.intervals = [...this.intervals.slice(1 - Budget.window), milliseconds];
    if (this.intervals.length < Budget.window) return false;
    const sorted = [...this.intervals].sort((a, b) => a - b);
    const median = sorted[sorted.length >> 1]!;
    this.rate = 1000 / Math.max(median, 1e-3);
    if (this.fixed !== null) return false;
    const before = this.adapted;
    if (this.rate < Budget.slow) {
      const share = Math.min(0.8, Math.max(0.4, this.rate / Budget.slow));
      this.adapted = Math.max(Budget.lowest, Math.round(this.adapted * share));
    } else if (this.rate > Budget.quick && limited) {
      this.adapted = Math.min(Budget.highest, Math.round(this.adapted * 1.25));
    }
    if (this.adapted === before) return false;
    this.intervals = [];
    return true;
  }

  /** A pause: what comes next says nothing about what was before. */
  pause(): void {
    this.intervals = [];
  }
}
