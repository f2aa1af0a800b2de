/** What automated tests may ask of the page, as `window.fovea`; nothing else is promised. */
export interface TestHook {
  /** The page's state, of the last picture. */
  state(): PageState;
  /** The point at a place of the window (CSS pixels), as a click there finds it. */
  pick(x: number, y: number): PickedState | null;
}

export interface PickedState {
  readonly position: readonly number[];
  readonly frame: number | null;
  readonly camera: number | null;
  readonly color: readonly number[];
}

export interface PageState {
  readonly pointsDrawn: number;
  readonly trianglesDrawn: number;
  /** Points, or vertices of triangles. */
  readonly pointsLoaded: number;
  readonly budget: number;
  /** Frames per second while pictures follow one another; 0 before any did. */
  readonly fps: number;
  readonly mode: string;
  readonly frame: number | null;
  readonly tilesLoading: number;
  /** Whether the picture stays as it is until somebody does something. */
  readonly atRest: boolean;
  readonly live: {
    readonly connected: boolean;
    readonly frames: number;
    readonly lastLatencyMs: number | null;
    readonly reconnects: number;
    readonly warnings: number;
  } | null;
  /** The lengths of the measured line's pieces (m). */
  readonly measured: readonly number[];
  readonly picked: PickedState | null;
  /** T_local_view, row by row, and the projection, both 4x4. */
  readonly camera: { readonly pose: readonly number[]; readonly projection: readonly number[] };
}

declare global {
  interface Window {
    fovea?: TestHook;
  }
}
