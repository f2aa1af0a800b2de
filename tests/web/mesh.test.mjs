// Meshes: every file by Khronos' glTF validator, what is in them by three.js.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { validateBytes } from 'gltf-validator';
import { Vector3 } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

import { bytesOf, light, TestMap } from './test_map.mjs';

const voxel = 0.2;
let map, plain, noise, single;
before(() => {
  map = new TestMap();
  // A floor of 100 m x 20 m with two posts; and points anywhere, in blobs.
  plain = map.exportOf('plain.fovea', 'plain', '--format', 'mesh', '--voxel', String(voxel));
  noise = map.export('noise', '--format', 'mesh', '--voxel', '3', '--uncolored');
  single = map.exportOf('plain.fovea', 'plain.glb', '--voxel', String(voxel));
});
after(() => map.remove());

const tilesOf = (folder) => readdirSync(join(folder, 'tiles')).map((tile) => join(folder, 'tiles', tile));

test('every file is valid glTF', async () => {
  const files = [...tilesOf(plain), ...tilesOf(noise), single];
  assert.ok(files.length > 10);
  for (const file of files) {
    const report = await validateBytes(new Uint8Array(bytesOf(file)));
    const { numErrors, numWarnings } = report.issues;
    assert.equal(numErrors + numWarnings, 0, `${file}: ${JSON.stringify(report.issues.messages)}`);
  }
});

test('the trees are sound', () => {
  for (const folder of [plain, noise]) {
    const tileset = JSON.parse(readFileSync(join(folder, 'tileset.json'), 'utf8'));
    assert.equal(tileset.asset.version, '1.1');
    assert.equal(tileset.root.refine, 'REPLACE');
    assert.equal('transform' in tileset.root, folder === noise);  // a map that knows its place
    let tiles = 0;
    const visit = (tile, outer) => {
      ++tiles;
      assert.ok(existsSync(join(folder, tile.content.uri)));
      if (!tile.children) assert.equal(tile.geometricError, 0);
      if (outer) {
        assert.ok(tile.geometricError <= outer.geometricError / 2);
        const [box, around] = [tile.boundingVolume.box, outer.boundingVolume.box];
        for (const axis of [0, 1, 2]) {
          const reach = Math.abs(box[axis] - around[axis]) + box[3 + 4 * axis];
          assert.ok(reach <= around[3 + 4 * axis] + 1e-6);
        }
      }
      for (const child of tile.children ?? []) visit(child, tile);
    };
    visit(tileset.root, null);
    assert.equal(tiles, readdirSync(join(folder, 'tiles')).length);
  }
});

/// The meshes of a file as three.js reads it: positions and normals, y up, colours in linear light.
async function read(file) {
  const gltf = await new GLTFLoader().parseAsync(bytesOf(file), '');
  gltf.scene.updateMatrixWorld(true);
  const vertices = [], triangles = [];
  gltf.scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const first = vertices.length;
    const { position, normal, color } = mesh.geometry.attributes;
    for (let i = 0; i < position.count; ++i) {
      vertices.push({
        p: new Vector3().fromBufferAttribute(position, i).applyMatrix4(mesh.matrixWorld),
        n: new Vector3().fromBufferAttribute(normal, i).transformDirection(mesh.matrixWorld),
        rgb: [color.getX(i), color.getY(i), color.getZ(i)],
      });
    }
    const { index } = mesh.geometry;
    for (let i = 0; i < index.count; i += 3) {
      triangles.push([0, 1, 2].map((k) => first + index.getX(i + k)));
    }
  });
  return { vertices, triangles };
}

/// Floor and posts are where they are, seen from above and from around, in their colours.
function check({ vertices, triangles }, { skirts }) {
  let posts = 0;
  for (const { p, n, rgb } of vertices) {
    // glTF's axes: y up, and z = -north. The floor is 100 m along x, from y = -10 to 10 in the map.
    assert.ok(p.x > -voxel && p.x < 100 + voxel && p.z > -10 - voxel && p.z < 10 + voxel, `at ${p.toArray()}`);
    if (p.y > 0.3) {
      ++posts;
      const red = Math.abs(rgb[0] - 1) + rgb[1] + rgb[2];
      assert.ok(red < 1e-3, `a post is red: ${rgb}`);
      const away = Math.min(...[[10, -4], [26, 8]].map(([x, y]) => Math.hypot(p.x - x, -p.z - y)));
      assert.ok(away < 0.25, `${away} m from the middle of a post`);
    } else if (Math.min(...[10, 26].map((x) => Math.abs(p.x - x))) > 1 && (!skirts || p.y > -0.1)) {
      assert.ok(Math.abs(p.y) < 0.002, `the floor is at ${p.y} m`);
      assert.ok(n.y > 0.999);
      assert.ok(rgb[1] > light(85) && rgb[1] < light(145), `its colour is ${rgb}`);
    }
  }
  assert.ok(posts > 10);
  let area = 0;
  for (const [a, b, c] of triangles) {
    const [u, v] = [b, c].map((corner) => vertices[corner].p.clone().sub(vertices[a].p));
    area += u.cross(v).y / 2;  // positive: counter-clockwise from above
  }
  assert.ok(Math.abs(area - 2000) < 60, `${area} m^2 of 2000`);
}

test('the one file shows the map, y up', async () => check(await read(single), { skirts: false }));

test('each level shows the map', async () => {
  const vertices = [], triangles = [];
  const tileset = JSON.parse(readFileSync(join(plain, 'tileset.json'), 'utf8'));
  const leaves = (tile) => (tile.children ? tile.children.flatMap(leaves) : [tile.content.uri]);
  for (const uri of leaves(tileset.root)) {
    const part = await read(join(plain, uri));
    triangles.push(...part.triangles.map((t) => t.map((corner) => corner + vertices.length)));
    vertices.push(...part.vertices);
  }
  check({ vertices, triangles }, { skirts: true });
});
