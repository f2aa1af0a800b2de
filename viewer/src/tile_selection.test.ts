import { Box3, PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, test } from 'vitest';

import { selectError, viewpointOf, type TileNode } from './tile_selection';

function tile(center: number[], half: number, error: number, points: number | null,
              children: TileNode[] = []): TileNode {
  const c = new Vector3(...center);
  const box = new Box3(c.clone().subScalar(half), c.clone().addScalar(half));
  return { box, geometricError: error, points, children };
}

/** Looks along -z at two tiles, one near and one far; each may be refined. */
function world() {
  const near = tile([0, 0, -20], 5, 0.1, 100, [tile([0, 0, -20], 5, 0, 1000)]);
  const far = tile([0, 0, -100], 5, 0.1, 100, [tile([0, 0, -100], 5, 0, 1000)]);
  const behind = tile([0, 0, 100], 5, 0.1, 100, [tile([0, 0, 100], 5, 0, 1000)]);
  const root = tile([0, 0, 0], 110, 1, 50, [near, far, behind]);
  const camera = new PerspectiveCamera(60, 1, 0.1, 1000);
  camera.updateMatrixWorld();
  return { root, view: viewpointOf(camera, 1000) };
}

describe('the error that a budget affords', () => {
  test('everything, where there is room', () => {
    const { root, view } = world();
    expect(selectError(root, view, 1e6, 0.5)).toEqual(
      { errorTarget: 0.5, points: 2000, limited: false });
  });

  test('the near tile before the far one, and never more than the budget', () => {
    const { root, view } = world();
    const { errorTarget, points, limited } = selectError(root, view, 1500, 0.5);
    expect(points).toBe(1100);
    expect(limited).toBe(true);
    const farError = 0.1 * view.pixelsPerUnit / 95;
    const nearError = 0.1 * view.pixelsPerUnit / 15;
    expect(errorTarget).toBeCloseTo(farError, 9);
    expect(nearError).toBeGreaterThan(errorTarget);
  });

  test('only the root, where nothing else fits', () => {
    const { root, view } = world();
    expect(selectError(root, view, 100, 0.5)).toMatchObject({ points: 50, limited: true });
  });

  test('nothing finer than can be seen', () => {
    const { root, view } = world();
    expect(selectError(root, view, 1e6, 3)).toEqual(
      { errorTarget: 3, points: 1100, limited: false });
  });

  test('stays finite with the eye inside a tile', () => {
    const { root, view } = world();
    const inside = { ...view, eye: new Vector3(0, 0, -20) };
    expect(Number.isFinite(selectError(root, inside, 1500, 0.5).errorTarget)).toBe(true);
  });

  test('tiles below one without points are guessed by those above it', () => {
    const { view } = world();
    const unknown = [tile([0, 0, -20], 5, 0.1, null), tile([0, 0, -25], 5, 0.1, null)];
    const reference = tile([0, 0, -20], 6, 0.2, 0, unknown);
    const root = tile([0, 0, -20], 7, 0.2, 100, [reference]);
    expect(selectError(root, view, 1e6, 0.5).points).toBe(400);
    expect(selectError(root, view, 300, 0.5)).toMatchObject({ points: 100, limited: true });
  });
});
