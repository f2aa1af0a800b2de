// `fovea localize ws://...`: a running robot in the map of an earlier drive.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';

import { record } from './bags.mjs';
import { BridgeServer } from './bridge_server.mjs';
import { ConvertDrives } from './convert_drives.mjs';
import { startProgram } from './program.mjs';
import { programNamedBy } from './test_map.mjs';

const limit = { timeout: 60_000 };  // a client that does not come would be waited for
const program = programNamedBy('FOVEA_PROGRAM');
const frames = 20;

const run = (...args) => execFileSync(program, [...args, '--quiet', '--force']);

/// The lines of a table of poses, as objects.
function posesOf(file) {
  const [head, ...lines] = readFileSync(file, 'utf8').trim().split('\n');
  const names = head.split(',');
  return lines.map((line) => Object.fromEntries(line.split(',').map((text, i) => [names[i], text])));
}

let drives, messages, map, expected;
before(() => {
  drives = new ConvertDrives({ frames });
  drives.simulate('first', 'camera.numbers=[0]', 'lidar.columns=900');
  drives.simulate('second', 'camera.numbers=[0]', 'lidar.columns=900', 'drive.pass=1');
  drives.derive('second', 'gnss', 'gnss');
  map = drives.path('first', 'map.fovea');
  run('map', drives.path('first', 'drive'), '-o', map, '--cameras', '0');
  messages = record(drives.drive('gnss'), { poses: 'gnss' });
  run('localize', drives.path('gnss', 'drive'), map, '-o', drives.path('file.csv'));
  expected = posesOf(drives.path('file.csv'));
  assert.ok(expected.every(({ state }) => state === 'localized'));
});
after(() => drives.remove());

/// `fovea localize URL`, as the process and a promise of {status, out, err}.
function localize(url, output, ...options) {
  return startProgram(['localize', url, map, '-o', drives.path(output), '--every-frame', ...options]);
}

async function bridge(t, played = messages, options = {}) {
  const server = await BridgeServer.start(played, options);
  server.needed = new Set(played.map(({ topic }) => topic).filter((topic) => !topic.includes('image')));
  t.after(() => server.close());
  return server;
}

/// The poses of a live run are those of the file.
function assertSame(poses) {
  assert.equal(poses.length, frames);
  for (const [i, pose] of poses.entries()) {
    assert.equal(pose.state, 'localized', `frame ${i}`);
    const apart = Math.hypot(...['x', 'y', 'z'].map((axis) => pose[axis] - expected[i][axis]));
    assert.ok(apart < 1e-6, `frame ${i} is ${apart} m off`);
  }
}

for (const ros1 of [false, true]) {
  test(`a second drive with ROS ${ros1 ? 1 : 2} is localized, and poses come back`, limit, async (t) => {
    const server = await bridge(t, record(drives.drive('gnss'), { poses: 'gnss', ros1 }), { ros1, takesPoses: true });
    const published = { '/fovea/odometry': [], '/fovea/state': [] };
    let isDone;
    const done = new Promise((resolve) => { isDone = resolve; });
    server.server.on('message', ({ channel, data }) => {
      published[channel.topic]?.push(JSON.parse(Buffer.from(data.buffer, data.byteOffset, data.byteLength)));
      if (published['/fovea/state'].length === frames - 1) isDone();
    });
    const name = `ros${ros1 ? 1 : 2}`;
    const { ended } = localize(server.url, `${name}.csv`, '--quiet', '--report', drives.path(`${name}.json`));
    await server.play();
    await done;  // all frames but the last one, whose sweep nothing ends
    server.close();
    const { status, err } = await ended;
    assert.equal(status, 0, err);
    const poses = posesOf(drives.path(`${name}.csv`));
    assertSame(poses);
    for (const [i, { pose }] of published['/fovea/odometry'].entries()) {
      for (const axis of ['x', 'y', 'z']) {
        assert.ok(Math.abs(pose.pose.position[axis] - poses[i][axis]) < 1e-6);
      }
      assert.ok(pose.covariance[0] > 0);
    }
    assert.ok(published['/fovea/odometry'].length >= frames - 1);
    assert.ok(published['/fovea/state'].every(({ data }) => JSON.parse(data).state === 'localized'));
    const { localize: figures, live } = JSON.parse(readFileSync(drives.path(`${name}.json`), 'utf8'));
    assert.equal(figures.guess, 'navigation');
    assert.equal(figures.localized, frames);
    assert.equal(live.scans_dropped, 0);
    assert.equal(live.images, 0);
  });
}

test('Ctrl-C writes the poses, which were printed', limit, async (t) => {
  const server = await bridge(t);
  const { child, ended } = localize(server.url, 'stopped.csv', '--pose-stream');
  await server.play();
  child.kill('SIGINT');
  const { status, out, err } = await ended;
  assert.equal(status, 130, err);
  assertSame(posesOf(drives.path('stopped.csv')));
  const lines = out.trim().split('\n');
  assert.equal(lines.length, frames);
  for (const [i, line] of lines.entries()) {
    assert.match(line, new RegExp(`^${i} \\d+ localized( -?[\\d.e-]+){13}$`));
  }
});

test('a lost connection and --guess first', limit, async (t) => {
  const server = await bridge(t);
  const { ended } = localize(server.url, 'cut.txt', '--guess', 'first');
  const half = messages.length / 2;
  await server.play(0, half);
  server.needed = new Set(messages.map(({ topic }) => topic).filter((topic) => /points/.test(topic)));
  await server.cut();
  await server.play(half);
  server.close();
  const { status, err } = await ended;
  assert.equal(status, 0, err);
  assert.match(err, /warning: the connection was lost 1 time/);
  assert.equal(readFileSync(drives.path('cut.txt'), 'utf8').trim().split('\n').length, frames);
});

test('options that contradict a running robot are wrong usage', limit, async () => {
  for (const [option, value] of [['--frames', '0:3'], ['--only', '2:1'], ['--truth', drives.path('first', 'drive')]]) {
    const { status, err } = await localize('ws://127.0.0.1:1', 'refused.csv', option, value).ended;
    assert.equal(status, 2);
    assert.match(err, new RegExp(`${option}.*running robot`));
  }
  const { status, err } = await localize(drives.path('gnss', 'drive'), 'refused.csv').ended;
  assert.equal(status, 2);
  assert.match(err, /--every-frame.*running robot/);
  assert.ok(!existsSync(drives.path('refused.csv')));
});
