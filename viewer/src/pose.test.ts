import { Matrix4, Vector3 } from 'three';
import { expect, test } from 'vitest';

import { interpolated, inverseOfRigid, matrixOfPose } from './pose';

const pose = [0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3];

test('twelve numbers are a matrix row by row', () => {
  expect(new Vector3(10, 0, 0).applyMatrix4(matrixOfPose(pose)).toArray()).toEqual([1, 12, 3]);
});

test('the inverse of a rigid motion undoes it', () => {
  const T = matrixOfPose(pose);
  const unit = T.clone().multiply(inverseOfRigid(T)).elements;
  new Matrix4().elements.forEach((value, i) => expect(unit[i]).toBeCloseTo(value, 12));
});

test('halfway is half the way and half the turn', () => {
  const half = interpolated(new Matrix4(), matrixOfPose(pose), 0.5);
  const at = new Vector3().setFromMatrixPosition(half);
  expect(at.distanceTo(new Vector3(0.5, 1, 1.5))).toBeLessThan(1e-12);
  const x = new Vector3().setFromMatrixColumn(half, 0);
  expect(Math.atan2(x.y, x.x)).toBeCloseTo(Math.PI / 4, 12);
});
