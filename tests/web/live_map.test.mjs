// `fovea map ws://...`: the map of a running robot is the map of its recording.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, renameSync } from 'node:fs';
import { after, before, test } from 'node:test';

import { record } from './bags.mjs';
import { BridgeServer } from './bridge_server.mjs';
import { launchBrowser, MapPage } from './browser.mjs';
import { ConvertDrives } from './convert_drives.mjs';
import { startProgram } from './program.mjs';
import { programNamedBy } from './test_map.mjs';

const limit = { timeout: 240_000 };  // a client that does not come would be waited for
const program = programNamedBy('FOVEA_PROGRAM');

const frames = 24;

/// The points and frames of a map. The digest is also of the kind and name of the drive, which differ.
function contentOf(name) {
  const hash = createHash('sha256');
  for (const file of ['map.ply', 'frames.csv']) {
    const path = drives.path(name, file);
    execFileSync(program, ['export', drives.path(name, 'map.fovea'), path, '--force',
      ...(file === 'frames.csv' ? ['--format', 'frames'] : [])]);
    hash.update(readFileSync(path));
  }
  return hash.digest('hex');
}

let drives, plain, expected;
before(() => {
  drives = new ConvertDrives({ frames });
  drives.simulate('simulated', 'camera.numbers=[0]', 'lidar.columns=900');
  drives.derive('simulated', 'poses', 'poses');
  plain = record(drives.drive('poses'));
  mapDrive('poses');
  expected = contentOf('poses');
});
after(() => drives.remove());

function mapDrive(name, ...options) {
  execFileSync(program, ['map', drives.path(name, 'drive'), '-o', drives.path(name, 'map.fovea'), '--cameras', '0',
    '--quiet', '--force', ...options]);
}

/// `fovea map URL`, as the process, a promise of {status, out, err} and a wait for words that it prints.
function mapOf(url, name, ...options) {
  mkdirSync(drives.path(name), { recursive: true });
  return startProgram(['map', url, '-o', drives.path(name, 'map.fovea'), '--cameras', '0', '--max-wait', '60',
    '--report', drives.path(name, 'report.json'), ...options]);
}

async function bridge(t, messages, options) {
  const server = await BridgeServer.start(messages, options);
  t.after(() => server.close());
  return server;
}

const reportOf = (name) => JSON.parse(readFileSync(drives.path(name, 'report.json'), 'utf8'));

/// Plays all messages to `fovea map`, and returns what it has printed.
async function play(t, name, messages, options, ...more) {
  const server = await bridge(t, messages, options);
  const { ended } = mapOf(server.url, name, '--every-frame', '--quiet', ...more);
  await server.play();
  server.close();
  const { status, err, out } = await ended;
  assert.equal(status, 0, err);
  assert.equal(err, '');
  return out;
}

for (const ros1 of [false, true]) {
  test(`a robot with ROS ${ros1 ? 1 : 2}`, limit, async (t) => {
    const name = `ros${ros1 ? 1 : 2}`;
    await play(t, name, record(drives.drive('poses'), { ros1, images: ros1 ? 'rgb8' : 'compressed' }), { ros1 });
    assert.equal(contentOf(name), expected);
    const { live, map } = reportOf(name);
    assert.equal(map.frames, frames);
    assert.equal(live.scans, frames);
    for (const lost of ['scans_dropped', 'scans_missing', 'images_late', 'images_missing', 'poses_late',
      'connection_losses', 'messages_damaged']) assert.equal(live[lost], 0, lost);
  });
}

for (const poses of ['tf', 'gnss']) {
  test(`poses by ${poses}`, limit, async (t) => {
    if (poses === 'gnss') drives.derive('simulated', 'gnss', 'gnss');
    const from = poses === 'gnss' ? 'gnss' : 'poses';
    mapDrive(from, '--no-imu');  // its rates are made up
    await play(t, `by_${poses}`, record(drives.drive(from), { poses }), {}, '--poses', poses, '--no-imu');
    assert.equal(contentOf(`by_${poses}`), contentOf(from));
  });
}

test('three lost connections: all that arrived is in the map', limit, async (t) => {
  const server = await bridge(t, plain);
  const { ended } = mapOf(server.url, 'cut', '--every-frame');
  const part = Math.ceil(plain.length / 4);
  for (let begin = 0; begin < plain.length; begin += part) {
    await server.play(begin, begin + part);
    // Calibration and fixed transforms have come.
    server.needed = new Set(plain.map(({ topic }) => topic).filter((topic) => !/info|static/.test(topic)));
    if (begin + part < plain.length) await server.cut();
  }
  server.close();
  const { status, err } = await ended;
  assert.equal(status, 0, err);
  assert.match(err, /warning: the connection was lost 3 times/);
  assert.equal(contentOf('cut'), expected);
  assert.equal(reportOf('cut').live.connection_losses, 3);
});

test('Ctrl-C ends the map, which is complete', limit, async (t) => {
  const server = await bridge(t, plain);
  const { child, ended } = mapOf(server.url, 'stopped', '--every-frame');
  await server.play();
  child.kill('SIGINT');
  const { status, err } = await ended;
  assert.equal(status, 130, err);
  assert.equal(contentOf('stopped'), expected);
});

test('a recorded run gives its map again, and a later one continues it', limit, async (t) => {
  const half = plain.length / 2, isFixed = ({ topic }) => /info|static/.test(topic);
  const run = async (messages, ...more) => {
    const server = await bridge(t, messages);
    const { ended } = mapOf(server.url, 'continued', '--every-frame', ...more);
    await server.play();
    server.close();
    const { status, err } = await ended;
    assert.equal(status, 0, err);
    const { map } = reportOf('continued');
    return map.frames + Object.values(map.frames_skipped).reduce((sum, count) => sum + count, 0);
  };
  const first = await run(plain.slice(0, half), '--record', drives.path('continued', 'drive'));
  assert.ok(first > 5 && first < frames);
  const live = contentOf('continued');
  mkdirSync(drives.path('recorded'));
  renameSync(drives.path('continued', 'drive'), drives.path('recorded', 'drive'));
  mapDrive('recorded');
  assert.equal(contentOf('recorded'), live);
  // The last image of the first run may belong to the first scan of the second one.
  const again = [...plain.slice(0, half).filter(isFixed), ...plain.slice(half)];
  assert.equal(await run(again, '--resume'), frames);
});

test('what is missing is named', limit, async (t) => {
  const server = await bridge(t, plain.filter(({ topic }) => topic !== '/tf_static'));
  const { ended, saying } = mapOf(server.url, 'incomplete');
  await server.play();
  await saying(/^still missing: .*camera/m);
  server.close();
  const { status, err } = await ended;
  assert.equal(status, 1, err);
  assert.match(err, /error: .*camera.*ws:/);
  assert.ok(!existsSync(drives.path('incomplete', 'map.fovea')));
});

test('scans and images that the bridge drops are counted', limit, async (t) => {
  const counts = new Map();
  const kept = plain.filter(({ topic }) => {
    if (!/points|image_raw/.test(topic)) return true;
    const count = (counts.get(topic) ?? 0) + 1;
    counts.set(topic, count);
    return count < 10 || count % 10 !== (topic.includes('points') ? 3 : 2);  // a steady rate, and then gaps
  });
  await play(t, 'dropped', kept, {});
  const { live, map } = reportOf('dropped');
  assert.equal(live.scans_missing, 2);
  assert.equal(live.images_missing, 2);
  assert.equal(map.frames, frames - 4);
  assert.deepEqual(Object.values(map.frames_skipped), [2]);  // of one camera, without its image
});

test('images that come 150 ms late are used', limit, async (t) => {
  const late = plain.map((message) => (message.topic.includes('image_raw')
    ? { ...message, time: message.time + 150_000_000n } : message))
    .sort((a, b) => (a.time < b.time ? -1 : Number(a.time > b.time)));
  await play(t, 'late', late, {});
  const { live } = reportOf('late');
  assert.equal(live.images_late, 0);
  assert.equal(contentOf('late'), expected);
});

test('poses come as lines', limit, async (t) => {
  const out = await play(t, 'poses_out', plain, {}, '--pose-stream');
  const lines = out.trim().split('\n');
  assert.equal(lines.length, frames);
  for (const [i, line] of lines.entries()) assert.match(line, new RegExp(`^${i} \\d+ tracked( -?[\\d.e-]+){7,13}$`));
});

test('the growing map is shown, and after the end', limit, async (t) => {
  const server = await bridge(t, plain);
  const { child, ended, saying } = mapOf(server.url, 'shown', '--every-frame', '--live=0');
  await server.play();
  server.close();
  const [, url] = await saying(/is still shown at (\S+)/, 'out');
  assert.equal((await (await fetch(new URL('frames.json', url))).json()).index.length, frames);
  child.kill('SIGINT');
  const { status, err } = await ended;
  assert.equal(status, 130, err);
  assert.equal(contentOf('shown'), expected);
});

test('the page shows the latest images, and says which are gone', limit, async (t) => {
  const half = plain.length / 2;
  const play = async (messages, ...more) => {
    const server = await bridge(t, messages);
    const run = mapOf(server.url, 'images', '--every-frame', ...more);
    await server.play();
    server.close();
    return run;
  };
  const { ended: first } = await play(plain.slice(0, half));
  assert.equal((await first).status, 0);
  const again = [...plain.slice(0, half).filter(({ topic }) => /info|static/.test(topic)), ...plain.slice(half)];
  const { child, ended, saying } = await play(again, '--resume', '--live=0');
  const [, url] = await saying(/is still shown at (\S+)/, 'out');
  const browser = await launchBrowser();
  t.after(() => browser.close());
  const map = await MapPage.open(browser, `${url}#frame=${frames - 1}&camera=0`);
  await map.page.locator('.frame-view.has-image').waitFor();
  await map.page.evaluate(() => { location.hash = '#frame=0&camera=0'; });
  await map.page.getByText('The image is no longer kept.').waitFor();
  assert.equal(await map.page.locator('.frame-view.has-image').count(), 0);
  await map.page.evaluate((last) => { location.hash = `#frame=${last}&camera=0`; }, frames - 1);
  await map.page.locator('.frame-view.has-image').waitFor();
  assert.equal(await map.page.getByText('The image is no longer kept.').count(), 0);
  child.kill('SIGINT');
  assert.equal((await ended).status, 130);
});

test('options that contradict a running robot are wrong usage', limit, async () => {
  for (const [option, value] of [['--frames', '0:3'], ['--rate', '10']]) {
    const { status, err } = await mapOf('ws://127.0.0.1:1', 'refused', option, value).ended;
    assert.equal(status, 2);
    assert.match(err, new RegExp(`${option}.*running robot`));
  }
  const { status, err } = await mapOf(drives.path('poses', 'drive'), 'refused').ended;
  assert.equal(status, 2);
  assert.match(err, /--max-wait.*only with a running robot/);
});
