// The page while `fovea map --live` makes a map.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { launchBrowser, MapPage, serve } from './browser.mjs';
import { programNamedBy } from './test_map.mjs';

const program = programNamedBy('FOVEA_PROGRAM');
const sample = process.env.FOVEA_SAMPLE_DRIVE;
let folder, browser;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'fovea_live_'));
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

/// The real drive where it is, else a simulated one.
function liveDrive() {
  if (sample && existsSync(sample)) return sample;
  assert.ok(!process.env.FOVEA_REQUIRE_KITTI, 'the sample drive is missing');
  execFileSync(program, ['simulate', '-o', join(folder, 'drive'), '--frames', '20', '--quiet']);
  return join(folder, 'drive');
}

test('the map grows while the vehicle drives, and stays when the drive ends', async (t) => {
  const server = await serve(program, 'map', liveDrive(), '-o', join(folder, 'live.fovea'), '--live=0',
    '--rate', '2', '--set', 'surface.spacing_m=0.05');
  t.after(() => server.stop('SIGKILL'));  // whatever failed
  const map = await MapPage.open(browser, server.url);
  const first = await map.comesTo('frames', (state) => state.live?.frames > 2);
  assert.ok(first.live.connected);
  const later = await map.comesTo('more points', (state) =>
    state.pointsLoaded > first.pointsLoaded && state.live.frames > first.live.frames + 3);
  assert.equal(later.live.warnings, 0);
  assert.ok(later.live.lastLatencyMs !== null);
  assert.notDeepEqual(later.camera.pose, first.camera.pose, 'the view follows the vehicle');

  // The end of the drive: what is in view is there all the time.
  let least = Infinity, state;
  const end = Date.now() + 150_000;
  do {
    state = await map.state();
    least = Math.min(least, state.pointsDrawn);
    assert.ok(Date.now() < end, `the page does not take over the finished map: ${JSON.stringify(state)}`);
  } while (state.live !== null);
  await map.settles();
  // How many points stand for the view is the budget's; a gap would have been a picture of none.
  assert.ok(least > 5_000, `once only ${least} points were drawn`);
  assert.match(server.said(), /still shown/);
  assert.deepEqual(map.complaints, []);
  await map.close();
  assert.equal(await server.stop(), 130);
});

test('it comes back after the server was away', async (t) => {
  execFileSync(program, ['simulate', '-o', join(folder, 'again'), '--frames', '40', '--seed', '2', '--quiet',
    '--set', 'camera.width=414', '--set', 'camera.height=125', '--set', 'camera.focal=240',
    '--set', 'camera.cx=203', '--set', 'camera.cy=57']);
  const output = join(folder, 'again.fovea');
  const live = (port, ...more) => serve(program, 'map', join(folder, 'again'), '-o', output, `--live=${port}`,
    '--rate', '2', '--set', 'surface.spacing_m=0.08', ...more);
  const server = await live(0);
  t.after(() => server.stop('SIGKILL'));
  const map = await MapPage.open(browser, server.url);
  const before = await map.comesTo('frames', (state) => state.live?.frames > 6);
  assert.equal(await server.stop(), 130);  // what was mapped is committed
  await map.comesTo('the loss is noticed', (state) => state.live && !state.live.connected);
  const again = await live(server.port, '--resume');
  t.after(() => again.stop('SIGKILL'));
  const back = await map.comesTo('a connection', (state) => state.live?.connected && state.live.reconnects > 0);
  assert.ok(back.live.reconnects >= 1);
  const all = await map.comesTo('all points again', (state) =>
    state.pointsLoaded >= 0.9 * before.pointsLoaded && state.frame > before.frame);
  assert.ok(all.live.connected);
  await map.close();
  assert.equal(await again.stop(), 130);
});
