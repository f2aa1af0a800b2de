// What 3DTilesRendererJS would load of a tileset in a browser.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath, pathToFileURL } from 'node:url';

/// World positions (p) and colors (rgb) of the points that are shown from `eye` towards `target` at an error
/// target (pixels). An update takes 10 ms.
export async function shownPoints(folder, { eye, target, errorTarget, updates }) {
  globalThis.window ??= { location: { href: 'file:///' } };
  globalThis.self ??= globalThis;
  globalThis.requestAnimationFrame ??= (f) => setTimeout(f, 1);
  globalThis.cancelAnimationFrame ??= clearTimeout;
  const { PerspectiveCamera, Vector3 } = await import('three');
  const { TilesRenderer } = await import('3d-tiles-renderer/three');
  const renderer = new TilesRenderer(pathToFileURL(join(folder, 'tileset.json')).href);
  renderer.registerPlugin({
    async fetchData(url) {
      return new Response(readFileSync(fileURLToPath(url)));
    },
  });
  const failures = [];
  renderer.addEventListener('load-error', ({ error }) => failures.push(error));
  renderer.errorTarget = errorTarget;

  const camera = new PerspectiveCamera(60, 1, 1, 1e4);
  camera.position.set(...eye);
  camera.lookAt(new Vector3(...target));
  camera.updateMatrixWorld();
  renderer.setCamera(camera);
  renderer.setResolution(camera, 1000, 1000);
  for (let i = 0; i < updates; ++i) {
    renderer.update();
    await sleep(10);
  }
  assert.deepEqual(failures, []);

  renderer.group.updateMatrixWorld(true);
  const points = [];
  renderer.group.traverse((object) => {
    if (!object.isPoints) return;
    const { position, color } = object.geometry.attributes;
    for (let i = 0; i < position.count; ++i) {
      const p = new Vector3().fromBufferAttribute(position, i).applyMatrix4(object.matrixWorld);
      points.push({ p: p.toArray(), rgb: [color.getX(i), color.getY(i), color.getZ(i)] });
    }
  });
  renderer.dispose();
  return points;
}
