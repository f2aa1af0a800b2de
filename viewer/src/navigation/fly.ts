import { forwardOf, rightOf, steepest, type View } from './view';

const forward = ['KeyW', 'ArrowUp'];
const back = ['KeyS', 'ArrowDown'];
const left = ['KeyA', 'ArrowLeft'];
const right = ['KeyD', 'ArrowRight'];
const up = ['KeyE', 'PageUp'];
const down = ['KeyQ', 'PageDown'];

export const flyKeys: ReadonlySet<string> =
  new Set([...forward, ...back, ...left, ...right, ...up, ...down]);

function axis(keys: ReadonlySet<string>, plus: string[], minus: string[]): number {
  const held = (names: string[]) => (names.some((name) => keys.has(name)) ? 1 : 0);
  return held(plus) - held(minus);
}

/** Where the keys held down lead in `seconds` at `speed` m/s. */
export function flown(view: View, keys: ReadonlySet<string>, speed: number,
                      seconds: number): View {
  const step = speed * seconds * (keys.has('ShiftLeft') || keys.has('ShiftRight') ? 4 : 1);
  const eye = view.eye.clone()
    .addScaledVector(forwardOf(view), step * axis(keys, forward, back))
    .addScaledVector(rightOf(view), step * axis(keys, right, left));
  eye.z += step * axis(keys, up, down);
  return { ...view, eye };
}

/** Turns the head: the picture follows the cursor. */
export function looked(view: View, dx: number, dy: number, pixelsPerUnit: number): View {
  const pitch = view.pitch + dy / pixelsPerUnit;
  return {
    ...view,
    yaw: view.yaw + dx / pixelsPerUnit,
    pitch: Math.min(steepest, Math.max(-steepest, pitch)),
  };
}
