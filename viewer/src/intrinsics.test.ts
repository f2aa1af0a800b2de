import { Matrix4, Vector3 } from 'three';
import { describe, expect, test } from 'vitest';

import { fitted, imageProjection, projectionOf } from './intrinsics';
import { matrixOfPose, viewOfCamera } from './pose';

const camera = { width: 1242, height: 375, fx: 721.5, fy: 700, cx: 609.6, cy: 172.9 };

/** Where a point of the camera's frame falls in the window, in CSS pixels. */
function windowPixel(projection: Matrix4, p: Vector3, width: number, height: number) {
  const q = new Vector3(p.x, -p.y, -p.z).applyMatrix4(projection);
  return { x: (q.x + 1) / 2 * width, y: (1 - q.y) / 2 * height };
}

function cameraPixel(p: Vector3) {
  return { u: camera.fx * p.x / p.z + camera.cx, v: camera.fy * p.y / p.z + camera.cy };
}

const places = [new Vector3(0, 0, 10), new Vector3(-4, 1.2, 8), new Vector3(7, -1.5, 30)];

describe('a camera becomes a projection', () => {
  test('the middle of pixel (u, v) is at u + 1/2, v + 1/2 of a picture of its size', () => {
    const projection = imageProjection(camera, 0.1, 100);
    for (const p of places) {
      const { u, v } = cameraPixel(p);
      const at = windowPixel(projection, p, camera.width, camera.height);
      expect(at.x).toBeCloseTo(u + 0.5, 6);
      expect(at.y).toBeCloseTo(v + 0.5, 6);
    }
  });

  test('an image anywhere in a window coincides with it to the pixel', () => {
    const image = { x: 40, y: 120, width: 621, height: 187.5 };
    const projection = projectionOf(camera, image, 800, 600, 0.1, 100);
    for (const p of places) {
      const { u, v } = cameraPixel(p);
      const at = windowPixel(projection, p, 800, 600);
      expect(at.x).toBeCloseTo(40 + (u + 0.5) / 2, 6);
      expect(at.y).toBeCloseTo(120 + (v + 0.5) / 2, 6);
    }
  });

  test('its near and far planes are those asked for', () => {
    const projection = imageProjection(camera, 0.5, 50);
    expect(new Vector3(0, 0, -0.5).applyMatrix4(projection).z).toBeCloseTo(-1, 9);
    expect(new Vector3(0, 0, -50).applyMatrix4(projection).z).toBeCloseTo(1, 9);
  });
});

test('an image is fitted without changing its shape', () => {
  const area = { x: 10, y: 20, width: 1000, height: 900 };
  expect(fitted(1000, 500, area)).toEqual({ x: 10, y: 220, width: 1000, height: 500 });
  expect(fitted(500, 1000, area)).toEqual({ x: 285, y: 20, width: 450, height: 900 });
});

test('what the camera has in front is in front of the renderer, its right on the right', () => {
  // KITTI's axes: the camera looks along the LiDAR's x, its x is -y, its y is -z.
  const T_cam_lidar = [0, -1, 0, 0.1, 0, 0, -1, -0.2, 1, 0, 0, -0.3];
  const T_local_lidar = matrixOfPose([0, -1, 0, 100, 1, 0, 0, 200, 0, 0, 1, 5]);
  const T_view_local = viewOfCamera(T_local_lidar, T_cam_lidar).invert();
  const p_lidar = new Vector3(10, 2, 1);
  const p_cam = p_lidar.clone().applyMatrix4(matrixOfPose(T_cam_lidar));
  const p_view = p_lidar.clone().applyMatrix4(T_local_lidar).applyMatrix4(T_view_local);
  expect(p_view.x).toBeCloseTo(p_cam.x, 9);
  expect(p_view.y).toBeCloseTo(-p_cam.y, 9);
  expect(p_view.z).toBeCloseTo(-p_cam.z, 9);
});
