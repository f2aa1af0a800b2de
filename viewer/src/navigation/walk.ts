import { Vector3 } from 'three';

import type { Trajectory } from '../trajectory';
import { forwardOf, viewAlong, type View } from './view';

/** Rows that the arrow keys held down pass in a second. */
export const walkSpeed = 12;

export function walkStep(keys: ReadonlySet<string>): number {
  const ahead = ['KeyW', 'ArrowUp', 'ArrowRight'].some((key) => keys.has(key)) ? 1 : 0;
  const back = ['KeyS', 'ArrowDown', 'ArrowLeft'].some((key) => keys.has(key)) ? 1 : 0;
  return ahead - back;
}

/** From the LiDAR's place on the trajectory, with the head turned away from the heading. */
export function walked(trajectory: Trajectory, row: number, turned: Pick<View, 'yaw' | 'pitch'>,
                       fallback: View): View {
  if (trajectory.length === 0) return fallback;
  const eye = new Vector3().setFromMatrixPosition(trajectory.poseAt(row));
  return { eye, yaw: trajectory.heading(row) + turned.yaw, pitch: turned.pitch };
}

/** Behind and above the vehicle, looking along the drive. */
export function chasing(trajectory: Trajectory, row: number): View {
  const position = new Vector3().setFromMatrixPosition(trajectory.poseAt(row));
  const forward = forwardOf({ yaw: trajectory.heading(row), pitch: -0.27 });
  return viewAlong(position.addScaledVector(forward, -11), forward);
}
