// 3D Tiles: every tile by Khronos' glTF validator, the whole by 3DTilesRendererJS and three.js.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { validateBytes } from 'gltf-validator';

import { bytesOf, distance, ecefOfLocal, light, TestMap } from './test_map.mjs';
import { shownPoints } from './tiles_renderer.mjs';

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

/// From above the street.
const render = (errorTarget) => shownPoints(folder, {
  eye: ecefOfLocal([0, 0, 200]), target: ecefOfLocal([20, 25, 0]), errorTarget, updates: 100,
});

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
