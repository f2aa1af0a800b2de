import { Matrix4, Vector3 } from 'three';

import { interpolated, matrixOfPose } from './pose';
import type { Frame, Pose } from './protocol';

/** The frames of a drive in order, and where the vehicle was between them. */
export class Trajectory {
  private readonly frames: Frame[] = [];
  private readonly poses: Matrix4[] = [];
  private readonly rowOf = new Map<number, number>();

  constructor(frames: readonly Frame[] = []) {
    for (const frame of frames) this.put(frame);
  }

  get length(): number {
    return this.frames.length;
  }

  frame(row: number): Frame | undefined {
    return this.frames[row];
  }

  all(): readonly Frame[] {
    return this.frames;
  }

  pose(row: number): Matrix4 | undefined {
    return this.poses[row];
  }

  row(index: number): number | undefined {
    return this.rowOf.get(index);
  }

  /** The row whose frame number is nearest. */
  nearestRow(index: number): number {
    let best = 0;
    this.frames.forEach((frame, row) => {
      if (Math.abs(frame.index - index) < Math.abs(this.frames[best]!.index - index)) best = row;
    });
    return best;
  }

  /** Adds a frame or has a newer word on a known one. Frames come in order. */
  put(frame: Frame): void {
    const known = this.rowOf.get(frame.index);
    const row = known ?? this.frames.length;
    this.rowOf.set(frame.index, row);
    this.frames[row] = frame;
    this.poses[row] = matrixOfPose(frame.T_local_lidar);
  }

  movePose(index: number, T_local_lidar: Pose): void {
    const frame = this.frames[this.rowOf.get(index) ?? -1];
    if (frame) this.put({ ...frame, T_local_lidar });
  }

  clear(): void {
    this.frames.length = 0;
    this.poses.length = 0;
    this.rowOf.clear();
  }

  /** The vehicle's pose at a row that may lie between two, e.g. 3.25. */
  poseAt(row: number): Matrix4 {
    if (this.poses.length === 0) return new Matrix4();
    const at = Math.min(Math.max(row, 0), this.poses.length - 1);
    const before = Math.floor(at);
    const after = Math.min(before + 1, this.poses.length - 1);
    return interpolated(this.poses[before]!, this.poses[after]!, at - before);
  }

  position(row: number): Vector3 {
    return new Vector3().setFromMatrixPosition(this.poses[row]!);
  }

  /** Seconds from a row to the next: of the stamps, or the sensor's period where one lacks. */
  secondsAfter(row: number, period: number): number {
    const [from, to] = [this.frames[row]?.time, this.frames[row + 1]?.time];
    if (from == null || to == null || to <= from) return period;
    return to - from;
  }

  /** The row that the drive reaches from `row` after some seconds. */
  rowAfter(row: number, seconds: number, period: number): number {
    const last = this.frames.length - 1;
    let at = row;
    let left = seconds;
    while (left > 0 && at < last) {
      const step = this.secondsAfter(Math.floor(at), period);
      const rest = (Math.floor(at) + 1 - at) * step;
      if (left < rest) return at + left / step;
      left -= rest;
      at = Math.floor(at) + 1;
    }
    return Math.min(at, Math.max(last, 0));
  }

  /** Which way the vehicle heads, horizontally: from its poses, x is forward. */
  heading(row: number): number {
    const x = new Vector3().setFromMatrixColumn(this.poseAt(row), 0);
    return Math.atan2(x.y, x.x);
  }
}
