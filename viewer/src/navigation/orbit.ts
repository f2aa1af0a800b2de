import { Matrix4, Vector3 } from 'three';

import { forwardOf, rightOf, steepest, upOf, type View } from './view';

/** Round a point: `turn` to the left and `tilt` upwards move the eye so that the point stays where
 * it is on the screen. */
export function orbited(view: View, pivot: Vector3, turn: number, tilt: number): View {
  const pitch = Math.min(steepest, Math.max(-steepest, view.pitch + tilt));
  const level = new Matrix4().makeRotationZ(turn);
  const side = rightOf(view).applyMatrix4(level);
  const raise = new Matrix4().makeRotationAxis(side, pitch - view.pitch);
  const eye = view.eye.clone().sub(pivot).applyMatrix4(level).applyMatrix4(raise).add(pivot);
  return { eye, yaw: view.yaw + turn, pitch };
}

/** Moves sideways so that what is `depth` metres away follows the cursor by `dx`, `dy` pixels. */
export function panned(view: View, depth: number, dx: number, dy: number,
                       pixelsPerUnit: number): View {
  const step = depth / pixelsPerUnit;
  const eye = view.eye.clone()
    .addScaledVector(rightOf(view), -dx * step)
    .addScaledVector(upOf(view), dy * step);
  return { ...view, eye };
}

/** Towards a point (factor below 1) or away from it. */
export function zoomed(view: View, target: Vector3, factor: number): View {
  const offset = view.eye.clone().sub(target);
  const nearest = 0.3;
  const longest = 2500;
  const length = offset.length();
  if (length < 1e-6) return view;
  const wanted = Math.min(longest, Math.max(nearest, length * factor));
  return { ...view, eye: target.clone().addScaledVector(offset, wanted / length) };
}

export function depthOf(view: View, point: Vector3): number {
  return Math.max(0.5, point.clone().sub(view.eye).dot(forwardOf(view)));
}
