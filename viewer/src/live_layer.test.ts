import { Vector3 } from 'three';
import { beforeEach, describe, expect, test } from 'vitest';

import { LiveLayer } from './live_layer';
import type { TileSection } from './live_message';
import { localPosition } from './picking';
import { PointMaterials } from './point_material';
import { PointObject } from './point_object';

/** Points of a tile whose x (mm) are given; red tells which. */
function section(x: number[], whole: boolean, tile: [number, number, number] = [1, 0, 0]) {
  const made: TileSection = {
    submap: 0, tile, whole, count: x.length,
    position: Uint16Array.from(x.flatMap((value) => [value, 0, 0])),
    color: Uint8Array.from(x.flatMap((value) => [value % 256, 2, 3, 255])),
    source: Uint8Array.from(x.flatMap(() => [0x81, 5, 6, 0])),
    frame: Float32Array.from(x.map(() => 7)),
    sight: Uint16Array.from(x.flatMap(() => [100, 200])),
  };
  return made;
}

describe('a growing map', () => {
  let layer: LiveLayer;
  const take = (...sections: TileSection[]) => layer.take({ type: 'points', frame: 7, sections });
  const objects = () => {
    const found: PointObject[] = [];
    layer.group.traverse((object) => { if (object instanceof PointObject) found.push(object); });
    return found;
  };

  beforeEach(() => {
    layer = new LiveLayer(new PointMaterials(), 4);
  });

  test('adds to a tile, far beyond its first size', () => {
    take(section([1, 2], true));
    for (let i = 0; i < 10; ++i) take(section(Array.from({ length: 200 }, (_, k) => k), false));
    expect(layer.points).toBe(2002);
    const [object] = objects();
    expect(object!.pointCount).toBe(2002);
    const color = object!.geometry.getAttribute('color');
    expect(Math.round(255 * color.getX(1))).toBe(2);
    expect(Math.round(255 * color.getX(2001))).toBe(199);
  });

  test('replaces a whole tile and forgets one that has gone', () => {
    take(section([1, 2, 3], true), section([4], true, [2, 0, 0]));
    take(section([9], true));
    expect(layer.points).toBe(2);
    take(section([], true));
    expect(layer.points).toBe(1);
    expect(objects()).toHaveLength(1);
  });

  test('puts points where the submap is', () => {
    take(section([500], true));
    layer.setSubmapPose(0, [0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30]);
    layer.group.updateMatrixWorld(true);
    const at = localPosition(objects()[0]!, 0);
    expect(at.distanceTo(new Vector3(10, 24.5, 30))).toBeLessThan(1e-6);
  });

  test('keeps camera, rule, views and spread in the order of finished tiles', () => {
    take(section([1], true));
    const source = objects()[0]!.geometry.getAttribute('_source');
    expect([source.getX(0), source.getY(0), source.getZ(0), source.getW(0)])
      .toEqual([255, 0x81, 5, 6]);
  });

  test('forgets everything at once', () => {
    take(section([1], true));
    layer.clear();
    expect(layer.points).toBe(0);
    expect(objects()).toHaveLength(0);
  });
});
