// Takes the pictures of docs/viewer.md:  node tests/web/pictures.mjs MAP.fovea DRIVE docs/pictures
// (FOVEA_PROGRAM names the program). To be of a simulated drive: KITTI's licence.
import { join } from 'node:path';

import { launchBrowser, MapPage, serve } from './browser.mjs';
import { programNamedBy } from './test_map.mjs';

const [map, drive, folder] = process.argv.slice(2);
const program = programNamedBy('FOVEA_PROGRAM');
const frame = 16;
const modes = ['Height', 'Range', 'Camera', 'Age', 'Measured', 'Views', 'Image error', 'Foveal zone'];

const server = await serve(program, 'view', map, '--drive', drive, '--port', '0', '--no-browser');
const browser = await launchBrowser();

/// From behind the vehicle at the frame.
async function link() {
  const frames = await (await fetch(`${server.url}frames.json`)).json();
  const T = frames.T_local_lidar[frames.index.indexOf(frame)];
  const [place, forward] = [[T[3], T[7], T[11]], [T[0], T[4], T[8]]];
  const along = (distance, up) =>
    place.map((value, i) => (value + distance * forward[i] + (i === 2 ? up : 0)).toFixed(2));
  return `${server.url}#at=${along(-6, 2.2)}&to=${along(8, -1)}&frame=${frame}`;
}

async function open(options) {
  const page = await MapPage.open(browser, await link(), options);
  const budget = page.page.getByRole('slider', { name: 'Points to draw at most' });
  if (!await budget.isVisible()) await page.button('Settings (H)').click();
  await budget.fill('6.5');
  await page.settles();
  return page;
}

async function take(page, name) {
  await page.settles();
  await page.page.screenshot({ path: join(folder, `viewer${name}.jpg`), type: 'jpeg', quality: 82 });
}

const wide = await open({ width: 1280, height: 720 });
await take(wide, '');
await wide.page.getByLabel('Foveal region of the frame').check();
await wide.page.getByLabel('Rays to its points').check();
await take(wide, '_foveal');
await wide.close();

const small = await open({ width: 960, height: 540 });
for (const mode of modes) {
  await small.mode(mode).click();
  await take(small, `_${mode.replace(' ', '_').toLowerCase()}`);
}
await small.mode('Photograph').click();
await small.button('Settings (H)').click();
await small.button('Look from the frame (I)').click();
await small.page.waitForTimeout(1500);  // the photograph comes
await take(small, '_frame');
await small.close();

const phone = await open({ width: 390, height: 780 });
await phone.button('Settings (H)').click();
await phone.button('Dark or light (T)').click();
await take(phone, '_phone');
await phone.close();

await browser.close();
await server.stop();
