// `fovea convert ws://...`: the topics of a running robot, as a Foxglove bridge sends them, give the drive that they are.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync } from 'node:fs';
import { after, before, test } from 'node:test';

import { record } from './bags.mjs';
import { BridgeServer } from './bridge_server.mjs';
import { ConvertDrives } from './convert_drives.mjs';
import { startProgram } from './program.mjs';

const limit = { timeout: 120_000 };  // a client that does not come would be waited for

let drives, plain, digest;
before(() => {
  drives = new ConvertDrives();
  drives.simulate('simulated', 'camera.numbers=[0]', 'lidar.columns=900');
  drives.derive('simulated', 'poses', 'poses');
  plain = record(drives.drive('poses'));
  digest = drives.digest('poses');
});
after(() => drives.remove());

/// `fovea convert URL -o NAME/drive`, as the process, a promise of {status, out, err} and a wait for words on stderr.
function convert(url, name, ...options) {
  mkdirSync(drives.path(name), { recursive: true });
  return startProgram(['convert', url, ...(name ? ['-o', drives.path(name, 'drive')] : []), ...options]);
}

async function bridge(t, messages, options) {
  const server = await BridgeServer.start(messages, options);
  t.after(() => server.close());
  return server;
}

for (const ros1 of [false, true]) {
  test(`a robot with ROS ${ros1 ? 1 : 2}`, limit, async (t) => {
    const name = `ros${ros1 ? 1 : 2}`;
    const server = await bridge(t, record(drives.drive('poses'), { ros1 }), { ros1 });
    const { ended } = convert(server.url, name, '--quiet');
    await server.play();
    server.close();
    const { status, err } = await ended;
    assert.equal(status, 0, err);
    assert.equal(err, '');
    assert.equal(drives.digest(name), digest);
  });
}

test('a recording stays, and no other one replaces it', limit, async (t) => {
  const server = await bridge(t, plain);
  const { ended } = convert(server.url, 'stays', '--quiet', '--duration', '1');  // the robot goes on
  await server.play();
  assert.equal((await ended).status, 0);
  assert.equal(drives.digest('stays'), digest);
  const again = await convert(server.url, 'stays', '--quiet', '--force').ended;
  assert.equal(again.status, 1);
  assert.match(again.err, /exists.*drive\.mcap/);
  const { status, stderr } = drives.convert(drives.path('stays', 'drive.mcap'), 'stays_again');
  assert.equal(status, 0, stderr);
  assert.equal(drives.digest('stays_again'), digest);
});

test('three lost connections: all that arrived is in the drive', limit, async (t) => {
  const server = await bridge(t, plain);
  const { ended } = convert(server.url, 'cut');
  const part = Math.ceil(plain.length / 4);
  for (let begin = 0; begin < plain.length; begin += part) {
    await server.play(begin, begin + part);
    if (begin + part < plain.length) await server.cut();
  }
  server.close();
  const { status, err } = await ended;
  assert.equal(status, 0, err);
  assert.match(err, /warning: the connection was lost 3 times/);
  assert.equal(drives.digest('cut'), digest);
});

test('Ctrl-C ends the recording', limit, async (t) => {
  const server = await bridge(t, plain);
  const { child, ended } = convert(server.url, 'stopped');
  await server.play();
  child.kill('SIGINT');
  const { status, err } = await ended;
  assert.equal(status, 130, err);
  assert.equal(drives.digest('stopped'), digest);
});

test('what is missing is named, and the recording stays', limit, async (t) => {
  const server = await bridge(t, plain.filter(({ topic }) => topic !== '/tf_static'));
  const { ended, saying } = convert(server.url, 'incomplete');
  await server.play();
  await saying(/^still missing: .*camera/m);
  server.close();
  const { status, err } = await ended;
  assert.equal(status, 1, err);
  assert.match(err, /^the recording is .*drive\.mcap$/m);
  assert.match(err, /error: .*camera/);
  assert.ok(existsSync(drives.path('incomplete', 'drive.mcap')));
  assert.ok(!existsSync(drives.path('incomplete', 'drive')));
});

test('the list of topics', limit, async (t) => {
  const server = await bridge(t, plain);
  const { ended } = convert(server.url, '', '--list');
  const { status, out } = await ended;
  assert.equal(status, 0);
  assert.match(out, /^\/lidar\/points {2}sensor_msgs\/msg\/PointCloud2, cdr$/m);
  assert.equal(out.trim().split('\n').length, server.channels.size);
});

test('bad addresses and servers are refused in one line', limit, async (t) => {
  const server = await bridge(t, plain);
  server.close();
  for (const [url, words] of [['ws://127.0.0.1:1', 'no bridge can be reached'],
    ['ws://127.0.0.1:99999', 'the port is no number'], ['wss://robot', 'over TLS'],
    ['ws://no.such.host.invalid', 'the host of the bridge is not found']]) {
    const { status, err } = await convert(url, 'refused', '--quiet').ended;
    assert.notEqual(status, 0);
    assert.match(err, /^fovea: error: [^\n]+\n$/);
    assert.ok(err.includes(words), err);
    for (const name of ['drive', 'drive.mcap']) assert.ok(!existsSync(drives.path('refused', name)), name);
  }
});
