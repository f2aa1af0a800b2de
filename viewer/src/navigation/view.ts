import { Matrix4, Vector3, type Box3, type PerspectiveCamera } from 'three';

export const steepest = 0.499 * Math.PI;

/** Where one stands and looks: z is up and the horizon level. Angles in radians. */
export interface View {
  readonly eye: Vector3;
  /** From the x axis, counter-clockwise from above. */
  readonly yaw: number;
  /** Up is positive. */
  readonly pitch: number;
}

export function forwardOf(view: Pick<View, 'yaw' | 'pitch'>): Vector3 {
  const level = Math.cos(view.pitch);
  return new Vector3(
    level * Math.cos(view.yaw), level * Math.sin(view.yaw), Math.sin(view.pitch));
}

export function rightOf(view: Pick<View, 'yaw'>): Vector3 {
  return new Vector3(Math.sin(view.yaw), -Math.cos(view.yaw), 0);
}

export function upOf(view: View): Vector3 {
  return new Vector3().crossVectors(rightOf(view), forwardOf(view));
}

/** T_local_view: the camera's x right, y up, z back. */
export function matrixOfView(view: View): Matrix4 {
  return new Matrix4()
    .makeBasis(rightOf(view), upOf(view), forwardOf(view).negate())
    .setPosition(view.eye);
}

/** Without the camera's roll. */
export function viewOfMatrix(T_local_view: Matrix4): View {
  const forward = new Vector3().setFromMatrixColumn(T_local_view, 2).negate();
  return viewAlong(new Vector3().setFromMatrixPosition(T_local_view), forward);
}

export function viewAlong(eye: Vector3, forward: Vector3): View {
  const pitch = Math.atan2(forward.z, Math.hypot(forward.x, forward.y));
  return {
    eye: eye.clone(),
    yaw: Math.atan2(forward.y, forward.x),
    pitch: Math.min(steepest, Math.max(-steepest, pitch)),
  };
}

/** All of a box, from the south and above. */
export function overviewOf(box: Box3, fovDegrees: number): View {
  const center = box.getCenter(new Vector3());
  const { x, y } = box.getSize(new Vector3());
  const forward = forwardOf({ yaw: Math.PI / 2, pitch: -Math.PI / 3.4 });
  const distance = 0.45 * Math.hypot(x, y) / Math.tan(fovDegrees * Math.PI / 360);
  return viewAlong(center.addScaledVector(forward, -Math.max(distance, 20)), forward);
}

/** Between two views, the shorter way round. */
export function between(from: View, to: View, share: number): View {
  const turn = Math.atan2(Math.sin(to.yaw - from.yaw), Math.cos(to.yaw - from.yaw));
  return {
    eye: from.eye.clone().lerp(to.eye, share),
    yaw: from.yaw + share * turn,
    pitch: from.pitch + share * (to.pitch - from.pitch),
  };
}

export function place(camera: PerspectiveCamera, T_local_view: Matrix4): void {
  camera.matrix.copy(T_local_view);
  camera.matrix.decompose(camera.position, camera.quaternion, camera.scale);
  camera.updateMatrixWorld(true);
}
