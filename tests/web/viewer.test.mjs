// The page of `fovea view`, in a real browser: a map of a simulated drive, and a large one.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import {
  countDifferent, countPixels, launchBrowser, MapPage, placeOf, serve,
} from './browser.mjs';
import { serveFolder } from './folder_server.mjs';
import { programNamedBy, TestMap } from './test_map.mjs';

const program = programNamedBy('FOVEA_PROGRAM');
let folder, drive, browser, server, plain, plainServer;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'fovea_viewer_'));
  const run = (...args) => execFileSync(program, args, { stdio: ['ignore', 'ignore', 'inherit'] });
  // Few points: software draws them.
  run('simulate', '-o', join(folder, 'drive'), '--frames', '12', '--seed', '3');
  drive = join(folder, 'drive/2026_01_01/2026_01_01_drive_0001_sync');
  run('map', drive, '-o', join(folder, 'map.fovea'), '--set', 'surface.spacing_m=0.05', '--quiet');
  plain = new TestMap();
  browser = await launchBrowser();
  server = await serve(program, 'view', join(folder, 'map.fovea'), '--drive', drive, '--port', '0',
    '--no-browser');
  plainServer = await serve(program, 'view', join(plain.folder, 'plain.fovea'), '--port', '0',
    '--no-browser');
});

after(async () => {
  await browser?.close();
  assert.equal(await server?.stop(), 130);
  assert.equal(await plainServer?.stop(), 130);
  plain?.remove();
  rmSync(folder, { recursive: true });
});

async function withPage(url, use, options) {
  const map = await MapPage.open(browser, url, options);
  try {
    await use(map);
    assert.deepEqual(map.complaints, []);
  } finally {
    await map.close();
  }
}

/// A page of a folder that Fovea wrote; a server left open would keep the tests from ending.
async function withFolder(output, use) {
  const web = await serveFolder(output);
  try {
    await withPage(web.url, use);
  } finally {
    web.stop();
  }
}

test('points are drawn', () => withPage(server.url, async (map) => {
  const picture = await map.picture();
  const background = (r, g, b) => r > 205 && g > 205 && b > 205;
  const drawn = picture.width * picture.height - countPixels(picture, background);
  assert.ok(drawn > 20_000, `${drawn} pixels are not background`);
}));

test('each colour mode changes the picture', () => withPage(server.url, async (map) => {
  const photograph = await map.picture();
  const pictures = new Map([['photograph', photograph]]);
  const modes = {
    Height: 'height', Range: 'range', Camera: 'camera', Age: 'age', Measured: 'rule',
    Views: 'views', 'Image error': 'error', 'Foveal zone': 'zone',
  };
  for (const label of Object.keys(modes)) {
    await map.mode(label).click();
    const picture = await map.picture();
    for (const [other, before] of pictures) {
      const different = countDifferent(before, picture);
      assert.ok(different > 5000, `${label} differs from ${other} in ${different} pixels`);
    }
    pictures.set(label, picture);
  }
  await map.mode('Photograph').click();
  assert.ok(countDifferent(photograph, await map.picture()) < 500, 'and back');
}));

test('a frame: map and photograph from the same place, with a slider', () =>
  withPage(server.url, async (map) => {
    await map.page.getByRole('spinbutton').fill('8');
    await map.page.getByRole('spinbutton').press('Enter');
    assert.equal((await map.comesTo('frame 8', (state) => state.frame === 8)).frame, 8);
    await map.button('Look from the frame (I)').click();
    const image = map.page.locator('img').first();
    await image.waitFor();
    await map.page.waitForFunction(() => [...document.images].some(
      (shown) => shown.src.includes('images/8/2.jpg') && shown.complete && shown.naturalWidth > 0));
    const slider = map.page.getByRole('slider', { name: /photograph/i });
    const shown = [];
    for (const place of ['Home', 'End']) {
      await slider.press(place);
      await map.settles();
      shown.push(await pixelsOf(map));
    }
    // Where both have something they show the same: simulated colours are close to the photograph's.
    const [a, b] = shown;
    let sum = 0, count = 0;
    for (let i = 0; i < a.data.length; i += 4) {
      const row = Math.floor(i / 4 / a.width), column = (i / 4) % a.width;
      const inside = row > 0.55 * a.height && row < 0.62 * a.height &&
        column > 0.3 * a.width && column < 0.7 * a.width;  // road, far from all controls
      if (!inside) continue;
      sum += Math.abs(a.data[i] - b.data[i]) + Math.abs(a.data[i + 1] - b.data[i + 1]) +
        Math.abs(a.data[i + 2] - b.data[i + 2]);
      ++count;
    }
    assert.ok(countDifferent(a, b) > 1000, 'the slider shows one, then the other');
    assert.ok(sum / count / 3 < 40, `the same road: ${sum / count / 3} grey values apart`);
  }));

/// The window as it is, photograph included.
async function pixelsOf(map) {
  const { PNG } = await import('pngjs');
  return PNG.sync.read(await map.page.screenshot());
}

test('a measured distance is the true one', () => withPage(plainServer.url, async (map) => {
  // As many points as these, however long it rests: what is picked twice is the same point.
  await map.page.getByRole('slider', { name: 'Points to draw at most' }).fill('5.5');
  await map.button('Settings (H)').click();  // it would lie over a post
  await map.button('Measure (M)').click();
  const state = await map.settles();
  const posts = [[10, -4, 0.5], [26, 8, 0.5]];
  const found = [];
  for (const post of posts) {
    const { x, y } = placeOf(state, post);
    const picked = await map.page.evaluate(([u, v]) => window.fovea.pick(u, v), [x, y]);
    assert.ok(picked, `there is a point at ${x}, ${y}`);
    const [r, g, b] = picked.color;
    assert.ok(r > 200 && g < 30 && b < 30, `it is the post's: ${picked.color}`);
    const off = Math.hypot(picked.position[0] - post[0], picked.position[1] - post[1]);
    assert.ok(Math.abs(off - 0.1) < 0.002, `on the post: ${off} m from its middle`);
    found.push(picked.position);
    await map.page.mouse.click(x, y);
  }
  const { measured } = await map.comesTo('a distance', ({ measured: lengths }) => lengths.length === 1);
  const [a, b] = found;
  const length = Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  assert.ok(Math.abs(measured[0] - length) < 0.001, `${measured[0]} m between points ${length} m apart`);
  assert.ok(Math.abs(measured[0] - 20) < 0.21, `${measured[0]} m between posts 20 m apart`);
}));

test('a click tells where a point comes from', () => withPage(plainServer.url, async (map) => {
  const state = await map.settles();
  const { x, y } = placeOf(state, [10, -4, 0.5]);
  await map.page.mouse.click(x, y);
  const { picked } = await map.comesTo('a point', (now) => now.picked !== null);
  assert.equal(picked.camera, 2);
  assert.equal(picked.frame, 8);
  await map.page.getByText('8.00 m').first().waitFor();  // its range
}));

test('five million points within a budget', () => withPage(plainServer.url, async (map) => {
  const state = await map.settles();
  assert.ok(state.pointsDrawn <= 1.3 * state.budget, `${state.pointsDrawn} of ${state.budget}`);
  const slider = map.page.getByRole('slider', { name: 'Points to draw at most' });
  const drawn = [];
  for (const points of [150_000, 600_000]) {
    await slider.fill(String(Math.log10(points).toFixed(2)));
    await map.settles();
    const { pointsDrawn, budget } = await map.state();
    assert.ok(Math.abs(budget / points - 1) < 0.05);
    assert.ok(pointsDrawn <= 1.3 * budget, `${pointsDrawn} of ${budget}`);
    drawn.push(pointsDrawn);
  }
  assert.ok(drawn[1] > 1.5 * drawn[0], `more where more may be: ${drawn}`);
}));

test('a link shows the view again', () => withPage(server.url, async (map) => {
  await map.mode('Height').click();
  await map.page.mouse.move(400, 300);
  await map.page.mouse.down();
  await map.page.mouse.move(520, 340, { steps: 5 });
  await map.page.mouse.up();
  await map.page.waitForFunction(() => location.hash.includes('mode=height'));
  let link = '', camera;
  while (link !== map.page.url()) {  // the address follows the view twice a second
    link = map.page.url();
    await map.page.waitForTimeout(1500);
    ({ camera } = await map.settles());
  }
  await withPage(link, async (again) => {
    const state = await again.settles();
    assert.equal(state.mode, 'height');
    state.camera.pose.forEach((value, i) => assert.ok(Math.abs(value - camera.pose[i]) < 0.02));
  });
}));

test('a telephone', () => withPage(server.url, async (map) => {
  await map.settles();
  const wide = await map.page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `${wide} pixels wide`);
}, { width: 390, height: 844 }));

test('a folder that any web server shows', async () => {
  const output = join(folder, 'site');
  execFileSync(program, ['export', join(folder, 'map.fovea'), output, '--format', '3dtiles', '--viewer',
    '--quiet']);
  await withFolder(output, async (map) => {
    const state = await map.settles();
    assert.ok(state.pointsDrawn > 10_000, `${state.pointsDrawn} points`);
    await map.mode('Range').click();
    await map.comesTo('another mode', (now) => now.mode === 'range');
  });
});

test('a mesh', async () => {
  const output = join(folder, 'mesh');
  execFileSync(program, ['export', join(folder, 'map.fovea'), output, '--format', 'mesh', '--viewer',
    '--voxel', '0.1', '--quiet']);
  await withFolder(output, async (map) => {
    const state = await map.settles();
    assert.equal(state.pointsDrawn, 0);
    assert.ok(state.trianglesDrawn > 5000, `${state.trianglesDrawn} triangles`);
    const picture = await map.picture();
    const background = (r, g, b) => r > 205 && g > 205 && b > 205;
    const drawn = picture.width * picture.height - countPixels(picture, background);
    assert.ok(drawn > 20_000, `${drawn} pixels are not background`);
    // Fewer vertices are allowed, fewer are drawn.
    await map.page.getByRole('slider', { name: 'Vertices to draw at most' }).fill('5');
    const coarse = await map.settles();
    assert.ok(coarse.trianglesDrawn <= 3 * coarse.budget, `${coarse.trianglesDrawn} of ${coarse.budget}`);
    // Two clicks on the road measure between any two places on it, 1.7 m below the first scan.
    await map.button('Measure (M)').click();
    for (const x of [12, 16]) {
      const place = placeOf(coarse, [x, 0, -1.7]);
      await map.page.mouse.click(place.x, place.y);
    }
    const { measured } = await map.comesTo('a length', (now) => now.measured.length === 1);
    assert.ok(Math.abs(measured[0] - 4) < 0.3, `${measured[0]} m`);
  });
});
