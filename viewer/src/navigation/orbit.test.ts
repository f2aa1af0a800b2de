import { Vector3 } from 'three';
import { describe, expect, test } from 'vitest';

import { depthOf, orbited, panned, zoomed } from './orbit';
import { forwardOf, matrixOfView, steepest, viewOfMatrix, type View } from './view';

const view: View = { eye: new Vector3(1, 2, 10), yaw: 0.4, pitch: -0.6 };
const pivot = new Vector3(8, 5, 1);

function inView(of: View, p: Vector3): Vector3 {
  return p.clone().applyMatrix4(matrixOfView(of).invert());
}

describe('the camera under the hands', () => {
  test('orbiting leaves the pivot where it is on the screen', () => {
    const before = inView(view, pivot);
    const after = inView(orbited(view, pivot, 0.7, 0.3), pivot);
    expect(after.distanceTo(before)).toBeLessThan(1e-9);
  });

  test('orbiting stops short of the poles', () => {
    expect(orbited(view, pivot, 0, -9).pitch).toBe(-steepest);
  });

  test('panning moves what is under the cursor with it', () => {
    const depth = depthOf(view, pivot);
    const before = inView(view, pivot);
    const after = inView(panned(view, depth, 30, 20, 500), pivot);
    expect((after.x - before.x) * 500 / depth).toBeCloseTo(30, 9);
    expect((after.y - before.y) * 500 / depth).toBeCloseTo(-20, 9);
  });

  test('zooming goes straight for the target and never through it', () => {
    const nearer = zoomed(view, pivot, 0.5);
    expect(nearer.eye.distanceTo(pivot)).toBeCloseTo(view.eye.distanceTo(pivot) / 2, 9);
    expect(zoomed(view, pivot, 0).eye.distanceTo(pivot)).toBeCloseTo(0.3, 9);
  });

  test('a view is the matrix it makes', () => {
    const back = viewOfMatrix(matrixOfView(view));
    expect(back.yaw).toBeCloseTo(view.yaw, 9);
    expect(back.pitch).toBeCloseTo(view.pitch, 9);
    expect(forwardOf(view).z).toBeLessThan(0);
  });
});
