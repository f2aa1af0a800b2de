import { Matrix4, Quaternion, Vector3 } from 'three';

import type { Pose } from './protocol';

export function matrixOfPose(pose: Pose): Matrix4 {
  const [a, b, c, x, d, e, f, y, g, h, i, z] = pose as number[];
  return new Matrix4().set(a!, b!, c!, x!, d!, e!, f!, y!, g!, h!, i!, z!, 0, 0, 0, 1);
}

/** Of a rigid motion: exact where a general inverse would round. */
export function inverseOfRigid(T: Matrix4): Matrix4 {
  const R = new Matrix4().extractRotation(T).transpose();
  const t = new Vector3().setFromMatrixPosition(T).applyMatrix4(R).negate();
  return R.setPosition(t);
}

/** A camera's x right, y down, z forward seen from the renderer's x right, y up, z back. */
const T_cam_view = new Matrix4().makeScale(1, -1, -1);

/** Where the renderer's camera stands to see what the camera saw. */
export function viewOfCamera(T_local_lidar: Matrix4, T_cam_lidar: Pose): Matrix4 {
  return T_local_lidar.clone()
    .multiply(inverseOfRigid(matrixOfPose(T_cam_lidar)))
    .multiply(T_cam_view);
}

/** Position on the straight line, rotation on the shortest arc. */
export function interpolated(from: Matrix4, to: Matrix4, share: number): Matrix4 {
  const p = new Vector3().setFromMatrixPosition(from)
    .lerp(new Vector3().setFromMatrixPosition(to), share);
  const q = new Quaternion().setFromRotationMatrix(from)
    .slerp(new Quaternion().setFromRotationMatrix(to), share);
  return new Matrix4().makeRotationFromQuaternion(q).setPosition(p);
}
