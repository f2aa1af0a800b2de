import { Matrix4 } from 'three';

/** A pinhole camera; integer pixel coordinates are pixel centres. */
export interface Intrinsics {
  readonly width: number;
  readonly height: number;
  readonly fx: number;
  readonly fy: number;
  readonly cx: number;
  readonly cy: number;
}

/** A rectangle of the window that an image fills, in CSS pixels from the upper left corner. */
export interface Rectangle {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** The largest rectangle of this shape inside the area, in its middle, on whole pixels. */
export function fitted(width: number, height: number, area: Rectangle): Rectangle {
  const scale = Math.min(area.width / width, area.height / height);
  const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
  return {
    x: Math.round(area.x + (area.width - w) / 2),
    y: Math.round(area.y + (area.height - h) / 2),
    width: w,
    height: h,
  };
}

/**
 * The projection by which a window shows exactly what the camera saw within `image`, and goes on
 * beyond it to the window's edges.
 */
export function projectionOf(camera: Intrinsics, image: Rectangle, windowWidth: number,
                             windowHeight: number, near: number, far: number): Matrix4 {
  // Pixel 0 reaches from -0.5 to 0.5: the image's outer edges are half a pixel out.
  const u = (x: number) => (x - image.x) / image.width * camera.width - 0.5;
  const v = (y: number) => (y - image.y) / image.height * camera.height - 0.5;
  const left = (u(0) - camera.cx) / camera.fx * near;
  const right = (u(windowWidth) - camera.cx) / camera.fx * near;
  const top = -(v(0) - camera.cy) / camera.fy * near;
  const bottom = -(v(windowHeight) - camera.cy) / camera.fy * near;
  return new Matrix4().makePerspective(left, right, top, bottom, near, far);
}

/** The camera's whole image, for a picture of its own size or another. */
export function imageProjection(camera: Intrinsics, near: number, far: number): Matrix4 {
  const image = { x: 0, y: 0, width: camera.width, height: camera.height };
  return projectionOf(camera, image, camera.width, camera.height, near, far);
}
