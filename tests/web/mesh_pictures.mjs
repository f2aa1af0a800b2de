// Takes the pictures of docs/exports.md:  node tests/web/mesh_pictures.mjs MAP.fovea docs/pictures
// (FOVEA_PROGRAM names the program). To be of a simulated drive: KITTI's licence.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { launchBrowser, MapPage } from './browser.mjs';
import { serveFolder } from './folder_server.mjs';
import { programNamedBy } from './test_map.mjs';

const [map, pictures] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'fovea_mesh_'));
const frame = 16;
const browser = await launchBrowser();

async function take(name, ...options) {
  const output = join(folder, name);
  execFileSync(programNamedBy('FOVEA_PROGRAM'), ['export', map, output, '--viewer', '--quiet', ...options]);
  const web = await serveFolder(output);
  const frames = await (await fetch(`${web.url}frames.json`)).json();
  const T = frames.T_local_lidar[frames.index.indexOf(frame)];
  const along = (distance, up) =>
    [T[3], T[7], T[11]].map((value, i) =>
      (value + distance * T[4 * i] + (i === 2 ? up : 0)).toFixed(2));
  const page = await MapPage.open(browser, `${web.url}#at=${along(-7, 3)}&to=${along(7, -1)}&show=`,
    { width: 960, height: 540 });
  await page.page.getByRole('slider', { name: /to draw at most/ }).fill('6.7');
  await page.button('Settings (H)').click();
  await page.settles();
  const canvas = page.page.locator('canvas').first();
  await page.page.addStyleTag({ content: '#app > * > *:not(canvas) { visibility: hidden !important; }' });
  await canvas.screenshot({ path: join(pictures, `${name}.jpg`), type: 'jpeg', quality: 82 });
  await page.close();
  web.stop();
}

await take('mesh_points', '--format', '3dtiles');
await take('mesh', '--format', 'mesh');
await browser.close();
rmSync(folder, { recursive: true });
