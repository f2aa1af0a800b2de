// 3D Tiles: every tile by Khronos' glTF validator, the whole by 3DTilesRendererJS and three.js.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath, pathToFileURL } from 'node:url';

import { validateBytes } from 'gltf-validator';

import { bytesOf, distance, ecefOfLocal, light, TestMap } from './test_map.mjs';

let map, folder;
before(() => {
  map = new TestMap();
  folder = map.export('tiles', '--format', '3dtiles');
});
after(() => map.remove());

test('every tile is valid glTF', async () => {
  const tiles = readdirSync(join(folder, 'tiles'));
  assert.ok(tiles.length > 0);
  for (const tile of tiles) {
    const report = await validateBytes(new Uint8Array(bytesOf(join(folder, 'tiles', tile))));
    const { numErrors, numWarnings } = report.issues;
    assert.equal(numErrors + numWarnings, 0, JSON.stringify(report.issues.messages));
  }
});

/// Calls f(tile, parent) for all tiles of a tileset.
function visit(tile, f, parent = null) {
  f(tile, parent);
  for (const child of tile.children ?? []) visit(child, f, tile);
}

test('the tree is sound', () => {
  const tileset = JSON.parse(readFileSync(join(folder, 'tileset.json'), 'utf8'));
  assert.equal(tileset.asset.version, '1.1');
  assert.ok(tileset.geometricError >= tileset.root.geometricError);
  assert.equal(tileset.root.refine, 'REPLACE');
  assert.equal(tileset.root.transform.length, 16);
  const uris = new Set();
  visit(tileset.root, (tile, parent) => {
    assert.ok(existsSync(join(folder, tile.content.uri)));
    uris.add(tile.content.uri);
    if (!tile.children) assert.equal(tile.geometricError, 0);
    if (!parent) return;
    assert.ok(tile.geometricError <= parent.geometricError / 2);
    const [box, outer] = [tile.boundingVolume.box, parent.boundingVolume.box];
    for (const axis of [0, 1, 2]) {
      const distances = Math.abs(box[axis] - outer[axis]) + box[3 + 4 * axis];
      assert.ok(distances <= outer[3 + 4 * axis] + 1e-6);
    }
  });
  assert.equal(uris.size, readdirSync(join(folder, 'tiles')).length);
});

/// What a renderer in a browser would load at this error target (pixels), as world positions.
async function render(errorTarget) {
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

  const eye = new Vector3(...ecefOfLocal([0, 0, 200])), target = new Vector3(...ecefOfLocal([20, 25, 0]));
  const camera = new PerspectiveCamera(60, 1, 1, 1e4);
  camera.position.copy(eye);
  camera.lookAt(target);
  camera.updateMatrixWorld();
  renderer.setCamera(camera);
  renderer.setResolution(camera, 1000, 1000);
  for (let i = 0; i < 100; ++i) {
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

test('a renderer shows every point where it is on earth, in its colour', async () => {
  const shown = await render(0);
  assert.equal(shown.length, map.points.length);
  const expected = map.points.map((point) => ({
    p: ecefOfLocal(point.local),
    rgb: point.color.map(light),
  }));
  const left = new Set(expected.keys());
  for (const { p, rgb } of shown) {
    const match = [...left].find((i) => distance(expected[i].p, p) < 0.001 &&
      distance(expected[i].rgb, rgb) < 2e-5);
    assert.notEqual(match, undefined, `no point of the map at ${p}`);
    left.delete(match);
  }
});

test('from afar a renderer shows fewer points', async () => {
  const shown = await render(1e5);
  assert.ok(shown.length > 0);
  assert.ok(shown.length < map.points.length);
});
