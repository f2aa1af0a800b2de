// `fovea map ws://...` and `convert ws://...` of robots that are not as they should be, and on full disks.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, statSync } from 'node:fs';
import { after, before, test } from 'node:test';

import { record } from './bags.mjs';
import { BridgeServer } from './bridge_server.mjs';
import { ConvertDrives } from './convert_drives.mjs';
import { startProgram } from './program.mjs';
import { programNamedBy } from './test_map.mjs';

const limit = { timeout: 240_000 };  // a client that does not come would be waited for
const program = programNamedBy('FOVEA_PROGRAM');
const frames = 70;  // two checkpoints

let drives, plain;
before(() => {
  drives = new ConvertDrives({ frames });
  drives.simulate('simulated', 'camera.numbers=[0]', 'lidar.columns=600');
  drives.derive('simulated', 'poses', 'poses');
  plain = record(drives.drive('poses'));
});
after(() => drives.remove());

async function bridge(t, messages, options) {
  const server = await BridgeServer.start(messages, options);
  t.after(() => server.close());
  return server;
}

function mapOf(url, name, options = []) {
  mkdirSync(drives.path(name), { recursive: true });
  return startProgram(['map', url, '-o', drives.path(name, 'map.fovea'), '--cameras', '0', '--every-frame',
    '--max-wait', '60', ...options]);
}

const sleep = (ms) => new Promise((done) => { setTimeout(done, ms); });

/// From now on no file grows beyond a size, as on a full disk.
const limitFiles = (child, bytes) => execFileSync('prlimit', ['--pid', String(child.pid), `--fsize=${bytes}`]);

/// One error, of a full disk. A note may say where the recording is.
const assertFull = (err) =>
  assert.match(err, /^(the recording is [^\n]+\n)?fovea: error: [^\n]*(File too large|full)[^\n]*\n$/);

/// Frames of a map that are committed, and its LiDARs.
function infoOf(name) {
  const map = drives.path(name, 'map.fovea');
  const { status, stdout } = spawnSync(program, ['info', '--json', map], { encoding: 'utf8' });
  return status === 0 ? JSON.parse(stdout) : { frames: 0, sensors: [] };
}

/// Plays the first messages, until some frames are committed.
async function playUntilCommit(server, name) {
  const part = Math.ceil(plain.length * 0.55);
  await server.play(0, part);
  while (infoOf(name).frames === 0) await sleep(50);
  return part;
}

test('on a full disk a map ends by itself, and keeps what was committed', limit, async (t) => {
  const server = await bridge(t, plain);
  const { child, ended } = mapOf(server.url, 'full', ['--quiet', '--record', drives.path('full', 'drive')]);
  const part = await playUntilCommit(server, 'full');
  limitFiles(child, 4096);
  await Promise.race([server.play(part), ended]);
  const { status, err } = await ended;  // the robot goes on
  assert.equal(status, 1);
  assertFull(err);
  assert.ok(infoOf('full').frames >= 30);
});

test('a recording is whole if the map has no room', limit, async (t) => {
  const server = await bridge(t, plain);
  const { child, ended } = mapOf(server.url, 'map_full', ['--quiet', '--record', drives.path('map_full', 'drive')]);
  const part = await playUntilCommit(server, 'map_full');
  limitFiles(child, 2 << 20);  // larger than the files of the recording
  await server.play(part);
  server.close();
  const { status, err } = await ended;
  assert.equal(status, 1);
  assertFull(err);
  const { frames: kept } = infoOf('map_full');
  assert.ok(kept >= 30 && kept < frames, String(kept));
  const scans = readFileSync(drives.path('map_full', 'drive/lidar/stamps.csv'), 'utf8').trim().split('\n');
  assert.equal(scans.length, frames + 1);
});

test('on a full disk `convert` ends by itself, and its recording can be converted', limit, async (t) => {
  const server = await bridge(t, plain);
  mkdirSync(drives.path('recording_full'), { recursive: true });
  const drive = drives.path('recording_full', 'drive'), recording = `${drive}.mcap`;
  const { child, ended } = startProgram(['convert', server.url, '-o', drive, '--quiet']);
  const part = Math.ceil(plain.length / 2);
  await server.play(0, part);
  limitFiles(child, statSync(recording).size + (1 << 20));
  await Promise.race([server.play(part), ended]);
  const { status, err } = await ended;
  assert.equal(status, 1);
  assertFull(err);
  assert.ok(!existsSync(drive));
  const { status: converted, stderr } = drives.convert(recording, 'recording_full_again');
  assert.equal(converted, 0, stderr);
});

test('of two channels of a topic one is read, and the other one takes over', limit, async (t) => {
  const server = await bridge(t, plain);
  const topic = '/lidar/points', first = server.channels.get(topic);
  const second = server.offer({ name: topic, type: 'sensor_msgs/msg/PointCloud2' });
  const { ended } = mapOf(server.url, 'channels');
  const half = plain.length / 2;
  await server.play(0, half);
  server.server.removeChannel(first);
  server.channels.set(topic, second);
  await server.play(half);
  server.close();
  const { status, err } = await ended;
  assert.equal(status, 0, err);
  assert.match(err, /warning: two channels have the topic \/lidar\/points: one of them is left out/);
  assert.equal(infoOf('channels').frames, frames);
});

test('two LiDARs of one name', limit, async (t) => {
  const lidars = ['/roof/points', '/roof/scans'];
  const messages = record(drives.drive('poses'), { lidars });
  const play = async (...options) => {
    const server = await bridge(t, messages);
    server.needed.delete(lidars[1]);  // it is not always chosen
    const { ended } = mapOf(server.url, 'lidars', ['--quiet', ...options]);
    await Promise.race([server.play(), ended]);
    server.close();
    return ended;
  };
  const both = await play('--lidar', lidars[0], '--lidar', lidars[1]);
  assert.equal(both.status, 0, both.err);
  const info = execFileSync(program, ['info', drives.path('lidars', 'map.fovea')], { encoding: 'utf8' });
  for (const name of ['roof', 'roof_2']) assert.match(info, new RegExp(`LiDAR +${name}:`));
  for (const [options, words] of [[[], /scans.*--lidar/], [['--lidar', lidars[0], '--lidar', lidars[0]], /twice/]]) {
    const { status, err } = await play('--force', ...options);
    assert.equal(status, 1);
    assert.match(err, /^fovea: error: [^\n]+\n$/);
    assert.match(err, words);
  }
});
