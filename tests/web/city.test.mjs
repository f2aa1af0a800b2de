// A city: its 3D Tiles by 3DTilesRendererJS, and the page of `fovea view` in a real browser.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { validateBytes } from 'gltf-validator';

import { launchBrowser, MapPage, serve } from './browser.mjs';
import { serveFolder } from './folder_server.mjs';
import { bytesOf, distance, programNamedBy, TestMap } from './test_map.mjs';
import { shownPoints } from './tiles_renderer.mjs';

const program = programNamedBy('FOVEA_PROGRAM');
let made, browser;

before(async () => {
  made = new TestMap();
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  made?.remove();
});

/// Earth-centred coordinates of the points of a PLY file: three doubles at the begin of each record.
function plyPoints(path) {
  const bytes = readFileSync(path);
  const begin = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const header = bytes.subarray(0, begin).toString();
  const sizes = { double: 8, float: 4, int: 4, char: 1, uchar: 1 };
  const stride = [...header.matchAll(/^property (\w+) /gm)]
    .reduce((sum, [, type]) => sum + sizes[type], 0);
  const count = Number(header.match(/element vertex (\d+)/)[1]);
  return Array.from({ length: count }, (_, i) =>
    [0, 8, 16].map((at) => bytes.readDoubleLE(begin + i * stride + at)));
}

/// World positions of all points in every detail, from 400 m above.
async function render(folder, center) {
  const farther = 1 + 400 / Math.hypot(...center);
  const points = await shownPoints(folder, {
    eye: center.map((x) => farther * x), target: center, errorTarget: 0, updates: 300,
  });
  return points.map(({ p }) => p);
}

test('a renderer shows every point of every tile where it is on earth', async () => {
  const tiles = made.exportOf('city', 'city_tiles', '--format', '3dtiles');
  const clouds = made.exportOf('city', 'city_ply', '--format', 'ply', '--crs', 'ecef');
  const expected = readdirSync(clouds).flatMap((name) => plyPoints(join(clouds, name)));
  assert.equal(expected.length, 6000);  // a third of 9000 has no color
  const center = [0, 1, 2].map((axis) =>
    expected.reduce((sum, p) => sum + p[axis], 0) / expected.length);
  const shown = await render(tiles, center);
  assert.equal(shown.length, expected.length);
  const cell = (p, shift = [0, 0, 0]) => p.map((x, axis) => Math.floor(x + shift[axis])).join();
  const cells = Map.groupBy?.(expected, (p) => cell(p)) ?? expected.reduce((map, p) =>
    map.set(cell(p), [...map.get(cell(p)) ?? [], p]), new Map());
  const around = [-0.5, 0.5].flatMap((x) => [-0.5, 0.5].flatMap((y) => [-0.5, 0.5].map((z) => [x, y, z])));
  for (const p of shown) {
    const near = around.flatMap((shift) => cells.get(cell(p, shift)) ?? []);
    assert.ok(near.some((q) => distance(p, q) < 0.001), `no point of the city at ${p}`);
  }
});

test('the levels above the tiles are valid glTF', async () => {
  const city = made.exportOf('city', 'city_q', '--format', '3dtiles');
  const folder = join(city, 'q', readdirSync(join(city, 'q'))[0]);
  const nodes = readdirSync(folder);
  assert.ok(nodes.length > 0);
  for (const node of nodes) {
    const { issues } = await validateBytes(new Uint8Array(bytesOf(join(folder, node))));
    assert.equal(issues.numErrors + issues.numWarnings, 0, JSON.stringify(issues.messages));
  }
});

async function withPage(url, use) {
  const map = await MapPage.open(browser, url);
  try {
    await use(map);
  } finally {
    await map.close();
  }
}

/// A point that is drawn near the middle of the window.
async function drawnPoint(map) {
  for (let radius = 0; radius < 200; radius += 10) {
    for (let turn = 0; turn < 8; ++turn) {
      const x = 480 + radius * Math.cos(turn), y = 320 + radius * Math.sin(turn);
      const picked = await map.page.evaluate(([px, py]) => window.fovea.pick(px, py), [x, y]);
      if (picked) return { x, y };
    }
  }
  return assert.fail('no point is drawn');
}

async function checkPage(map) {
  const state = await map.settles();
  assert.ok(state.pointsDrawn > 1000, `${state.pointsDrawn} points`);
  await map.comesTo('the paths of the drives', (now) => now.frame !== null);
  await map.page.getByText('3 tiles, 128 × 128 m, revision 1').waitFor();
  await map.page.getByText('1 drives').click();
  // A picked point has its place on earth, and no frame.
  await map.settles();
  const { x, y } = await drawnPoint(map);
  await map.page.mouse.click(x, y);
  const card = map.page.getByLabel('The picked point');
  await card.getByText('Latitude').waitFor();
  assert.ok((await card.textContent()).includes('49.0'));
  assert.equal(await card.getByText('Frame').count(), 0);
  // To the begin of a drive, and to the north again.
  await map.page.getByRole('button', { name: 'a 121 m' }).click();
  await map.comesTo('the drive from behind', ({ camera }) => Math.abs(camera.pose[7] - 33) < 1);
  await map.button('North: click to look there').click();
  await map.comesTo('the view to the north', ({ camera }) => Math.abs(camera.pose[1]) < 0.01 &&
    camera.pose[6] < -0.5);
  assert.deepEqual(map.complaints, []);
}

test('the page shows a city that fovea view serves', async () => {
  const server = await serve(program, 'view', join(made.folder, 'city'), '--port', '0', '--no-browser');
  try {
    await withPage(server.url, checkPage);
  } finally {
    assert.equal(await server.stop(), 130);
  }
});

test('the page shows a city of many tiles, also without overviews', async () => {
  const server = await serve(program, 'view', join(made.folder, 'large_city'), '--port', '0', '--no-browser');
  try {
    await withPage(server.url, async (map) => {
      await map.page.getByText('289 tiles').first().waitFor();
      assert.ok((await map.settles()).pointsDrawn > 1000);
      assert.deepEqual(map.complaints, []);
    });
  } finally {
    assert.equal(await server.stop(), 130);
  }
});

test('the page shows a city in a folder', async () => {
  const web = await serveFolder(made.exportOf('city', 'city_page', '--format', '3dtiles', '--viewer'));
  try {
    await withPage(web.url, checkPage);
  } finally {
    web.stop();
  }
});

test('the page names a tile that is damaged and shows the rest', async () => {
  writeFileSync(join(made.folder, 'city/tiles/1_0_0.fovea'), 'no map');
  const server = await serve(program, 'view', join(made.folder, 'city'), '--port', '0', '--no-browser');
  try {
    await withPage(server.url, async (map) => {
      await map.page.getByText('tile 1,0: ').first().waitFor();
      assert.ok((await map.state()).pointsDrawn > 500);
    });
  } finally {
    assert.equal(await server.stop(), 130);
  }
});
