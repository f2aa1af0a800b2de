import { Vector2, Vector3 } from 'three';

import { IntegerTarget } from './integer_target';
import type { MapScene } from './map_scene';
import type { PointObject } from './point_object';

export interface PickedPoint {
  readonly object: PointObject;
  readonly index: number;
  readonly position: Vector3;
}

/** The position of a point of an object, in `local`. */
export function localPosition(object: PointObject, index: number): Vector3 {
  const position = object.geometry.getAttribute('position');
  return new Vector3().fromBufferAttribute(position, index).applyMatrix4(object.matrixWorld);
}

/**
 * Which point is under the cursor: a small picture of ids around it, in which splats bulge, so that
 * each pixel belongs to the nearest point of a surface and hidden points to no pixel.
 */
export class Picking {
  private readonly target = new IntegerTarget(15, true);
  private readonly order = this.target.fromMiddle();

  constructor(private readonly scene: MapScene) {}

  /** `x`, `y` in CSS pixels from the window's upper left corner. */
  at(x: number, y: number): PickedPoint | null {
    const { renderer, camera, points, materials } = this.scene;
    const size = renderer.getDrawingBufferSize(new Vector2());
    const px = Math.floor(x * this.scene.ratio);
    const py = Math.floor(y * this.scene.ratio);
    const half = this.target.size >> 1;

    const around = camera.clone();
    around.matrixWorld.copy(camera.matrixWorld);
    around.matrixWorldInverse.copy(camera.matrixWorldInverse);
    around.matrixWorldAutoUpdate = false;
    // The part of the picture around the cursor fills the small one.
    const e = around.projectionMatrix.copy(camera.projectionMatrix).elements;
    const n = this.target.size;
    const [sx, sy] = [size.x / n, size.y / n];
    const cx = (2 * (px - half) + n) / size.x - 1;
    const cy = 1 - (2 * (py - half) + n) / size.y;
    // clip = (clip - c w) s, and w is -z.
    e[0]! *= sx;
    e[8] = sx * (e[8]! + cx);
    e[5]! *= sy;
    e[9] = sy * (e[9]! + cy);
    around.projectionMatrixInverse.copy(around.projectionMatrix).invert();

    points.overrideMaterial = materials.pickMaterial;
    renderer.setRenderTarget(this.target.target);
    renderer.clear();
    renderer.render(points, around);
    const pixels = this.target.read(renderer);
    renderer.setRenderTarget(null);
    points.overrideMaterial = null;

    for (const pixel of this.order) {
      if (pixels[pixel.at + 3] === 0) continue;
      const object = this.scene.drawnObjects().find(({ id }) => id === pixels[pixel.at]);
      if (!object) continue;
      const index = pixels[pixel.at + 1]!;
      return { object, index, position: localPosition(object, index) };
    }
    return null;
  }
}
