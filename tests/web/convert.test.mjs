// Recordings of ROS 2 and ROS 1, written by writers of other people: `fovea convert` gives the drive that was recorded.
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { after, before, test } from 'node:test';

import { record } from './bags.mjs';
import { ConvertDrives } from './convert_drives.mjs';
import { readScan } from './drive_folder.mjs';
import { opcodes, recordsOf, writeMcap } from './mcap_bag.mjs';
import { ros1SchemaOf } from './ros_messages.mjs';
import { ros1BagRecords, writeRos1Bag } from './ros1_bag.mjs';
import { writeRosbag2 } from './rosbag2_folder.mjs';

let drives, plain, ros1;
before(() => {
  drives = new ConvertDrives();
  drives.simulate('simulated', 'camera.numbers=[0]', 'lidar.columns=900');
  drives.derive('simulated', 'poses', 'poses');
  drives.derive('simulated', 'gnss', 'gnss');
  plain = record(drives.drive('poses'));
  ros1 = record(drives.drive('poses'), { ros1: true });
});
after(() => drives.remove());

const digests = new Map();

/// The converted drive has the stamps of the one that was recorded, and its map is the same to the last bit.
function checkConverted(recording, original, name, ...options) {
  const { status, stderr } = drives.convert(recording, name, ...options);
  assert.equal(status, 0, stderr);
  const stamps = ({ scans, cameras }) => [scans, ...cameras.map(({ images }) => images)].map((files) =>
    files.map(({ time }) => time));
  assert.deepEqual(stamps(drives.drive(name)), stamps(drives.drive(original)));
  if (!digests.has(original)) digests.set(original, drives.digest(original));
  assert.equal(drives.digest(name), digests.get(original));
}

for (const [name, compression, chunks] of [['zstd', 'zstd', true], ['uncompressed', 'none', true],
  ['without_chunks', 'none', false]]) {
  test(`MCAP, ${name}, poses of Odometry`, async () => {
    const bag = drives.path(`${name}.mcap`);
    await writeMcap(bag, plain, { compression, chunks });
    checkConverted(bag, 'poses', name);
  });
}

test('MCAP, lz4, poses of tf', async () => {
  const bag = drives.path('lz4.mcap');
  await writeMcap(bag, record(drives.drive('poses'), { poses: 'tf' }), { compression: 'lz4' });
  checkConverted(bag, 'poses', 'lz4', '--poses', 'tf');
});

test('MCAP in two files', async () => {
  const half = plain.length >> 1, bags = ['first.mcap', 'second.mcap'].map((name) => drives.path(name));
  await writeMcap(bags[0], plain.slice(0, half));
  await writeMcap(bags[1], plain.slice(half));
  checkConverted(bags[0], 'poses', 'halves', bags[1]);
});

const ros1Mcap = { profile: 'ros1', messageEncoding: 'ros1',
  schema: (type) => ({ encoding: 'ros1msg', data: ros1SchemaOf(type) }) };

test('MCAP with messages of ROS 1', async () => {
  const bag = drives.path('ros1.mcap');
  await writeMcap(bag, ros1, ros1Mcap);
  checkConverted(bag, 'poses', 'ros1_mcap');
});

for (const compression of ['none', 'bz2', 'lz4']) {
  test(`a bag of ROS 1, ${compression}`, () => {
    const bag = drives.path(`ros1_${compression}.bag`);
    writeRos1Bag(bag, ros1, { compression });
    checkConverted(bag, 'poses', `ros1_${compression}`);
  });
}

test('a bag of ROS 1, GNSS and IMU, raw images', () => {
  const bag = drives.path('ros1_gnss.bag');
  writeRos1Bag(bag, record(drives.drive('gnss'), { poses: 'gnss', images: 'bgr8', ros1: true }));
  checkConverted(bag, 'gnss', 'ros1_gnss');
});

test('a bag folder, GNSS and IMU', () => {
  const bag = drives.path('bag');
  writeRosbag2(bag, record(drives.drive('gnss'), { poses: 'gnss' }));
  checkConverted(bag, 'gnss', 'folder');
  // Rates and accelerations, and where tf says that they were measured.
  const [first] = readFileSync(drives.path('folder/drive/imu.csv'), 'utf8').split('\n').slice(1);
  assert.deepEqual(first.split(',').slice(5).map(Number), [0.01, -0.02, 0.03, 0.4, -0.1, 9.8]);
  assert.match(readFileSync(drives.path('folder/drive/drive.toml'), 'utf8'), /^\[imu\]\nT_lidar_imu = /m);
});

test('its database alone', () => {
  const bag = drives.path('alone');
  writeRosbag2(bag, plain);
  copyFileSync(`${bag}/alone_0.db3`, drives.path('copy.db3'));
  checkConverted(drives.path('copy.db3'), 'poses', 'database');
});

test('a bag folder in two files, each message compressed', () => {
  const bag = drives.path('split');
  writeRosbag2(bag, plain, { files: 2, compression: 'MESSAGE' });
  checkConverted(bag, 'poses', 'messages');
});

test('a bag folder whose files are compressed', () => {
  const bag = drives.path('whole');
  writeRosbag2(bag, plain, { files: 2, compression: 'FILE' });
  checkConverted(bag, 'poses', 'files');
});

for (const images of ['rgb8', 'bgr8']) {
  test(`raw images, ${images}, their rows padded`, async () => {
    const bag = drives.path(`${images}.mcap`);
    await writeMcap(bag, record(drives.drive('poses'), { images }));
    checkConverted(bag, 'poses', images);
  });
}

test('five cameras all round, grey ones and lenses among them', async () => {
  drives.simulate('round', 'camera.rig=surround', 'camera.grey_2=true', 'lidar.columns=600');
  drives.derive('round', 'surround', 'poses');
  const bag = drives.path('surround.mcap');
  await writeMcap(bag, record(drives.drive('surround'), { images: 'rgb8' }));
  checkConverted(bag, 'surround', 'all_round');
});

test('two LiDARs: one has to be named', async () => {
  const bag = drives.path('two.mcap');
  await writeMcap(bag, record(drives.drive('poses'), { lidars: ['/lidar/points', '/lidar/rear/points'] }));
  drives.refuses(bag, ['/lidar/points', '/lidar/rear/points', '--lidar']);
  checkConverted(bag, 'poses', 'one_of_two', '--lidar', '/lidar/points');
});

test('three LiDARs of one vehicle', async () => {
  const further = (number, forward, offset) => [`lidar_${number}.model=vlp16`, `lidar_${number}.forward=${forward}`,
    `lidar_${number}.roll=20`, `lidar_${number}.stamp_offset=${offset}`];
  drives.simulate('several', 'camera.numbers=[0]', 'lidar.model=vlp16', 'lidar.count=3', ...further(2, 1, 0.02),
    ...further(3, -1, -0.03));
  drives.derive('several', 'three', 'poses');
  const bag = drives.path('three.mcap');
  await writeMcap(bag, record(drives.drive('three')));
  const lidars = [1, 2, 3].flatMap((number) => ['--lidar', `/lidar_${number}/points`]);
  checkConverted(bag, 'three', 'three_converted', ...lidars);
  const stampsOf = (name) => drives.drive(name).lidars.map(({ scans }) => scans.map(({ time }) => time));
  assert.deepEqual(stampsOf('three_converted'), stampsOf('three'));
  assert.equal(stampsOf('three').length, 3);
  const { status, stderr } = drives.convert(bag, 'twice', ...lidars, '--lidar', '/lidar_1/points');
  assert.equal(status, 1);
  assert.match(stderr, /named twice/);
});

test('a Livox, within the resolution of its messages', async () => {
  drives.simulate('livox', 'camera.numbers=[0]', 'lidar.model=livox-avia', 'lidar.stamp_phase=0');
  drives.derive('livox', 'rosette', 'poses');
  const bag = drives.path('livox.mcap');
  await writeMcap(bag, record(drives.drive('rosette'), { livox: true }));
  const { status, stderr } = drives.convert(bag, 'livox_converted');
  assert.equal(status, 0, stderr);
  const [before, now] = ['rosette', 'livox_converted'].map((name) =>
    drives.drive(name).scans.map(({ path }) => readScan(path)));
  assert.equal(now.length, before.length);
  before.forEach((scan, frame) => {
    assert.equal(now[frame].count, scan.count);
    const values = (of, name, i) => of.data.readFloatLE(4 * (i * of.names.length + of.names.indexOf(name)));
    for (let i = 0; i < scan.count; ++i) {
      for (const name of ['x', 'y', 'z']) assert.equal(values(now[frame], name, i), values(scan, name, i));
      assert.ok(Math.abs(values(now[frame], 'time', i) - values(scan, 'time', i)) < 1e-8);
      assert.ok(Math.abs(values(now[frame], 'intensity', i) - values(scan, 'intensity', i)) < 0.502 / 255);
    }
  });
});

test('a camera by another name, no poses', async () => {
  const bag = drives.path('named.mcap');
  await writeMcap(bag, plain);
  const camera = 'front=/camera_0/image_raw/compressed';
  const { status, stderr } = drives.convert(bag, 'named', '--camera', camera, '--poses', 'none');
  assert.equal(status, 0, stderr);
  const { cameras, poses, positions, inertia } = drives.drive('named');
  assert.deepEqual(cameras.map(({ name, images }) => [name, images.length]), [['front', 4]]);
  assert.deepEqual([poses, positions, inertia], [[], [], []]);
  drives.refuses(bag, ['/nowhere'], '--camera', 'front=/nowhere');
  drives.refuses(bag, ['/nowhere'], '--lidar', '/nowhere');
});

test('an existing folder is replaced with --force alone', async () => {
  const bag = drives.path('again.mcap');
  await writeMcap(bag, plain);
  assert.equal(drives.convert(bag, 'twice').status, 0);
  const before = readFileSync(drives.path('twice/drive/drive.toml'));
  const { status, stderr } = drives.convert(bag, 'twice');
  assert.equal(status, 1);
  assert.match(stderr, /^fovea: error: .*--force.*\n$/);
  assert.deepEqual(readFileSync(drives.path('twice/drive/drive.toml')), before);
  assert.equal(drives.convert(bag, 'twice', '--force').status, 0);
});

test('a part of a recording', async () => {
  const bag = drives.path('part.mcap'), { scans } = drives.drive('poses');
  await writeMcap(bag, plain);
  const { status, stderr } = drives.convert(bag, 'part', '--start', '0.05', '--duration', '0.2');
  assert.equal(status, 0, stderr);
  const { scans: part, cameras: [{ images }] } = drives.drive('part');
  assert.deepEqual(part.map(({ time }) => time), scans.slice(1, 3).map(({ time }) => time));
  assert.ok(images.length >= 2 && images.length <= 4);
  drives.refuses(bag, ['--start'], '--start', '100');
});

test('the contents of a recording', async () => {
  const bag = drives.path('listed.bag');
  writeRos1Bag(bag, ros1);
  const { status, stdout } = drives.list(bag);
  assert.equal(status, 0);
  assert.match(stdout, /4 \/lidar\/points +sensor_msgs\/msg\/PointCloud2, frame velodyne, 0\.3. s, 9\.. Hz/);
  assert.match(stdout, /\/odom +nav_msgs\/msg\/Odometry/);
});

// What is no such recording.

const refusal = async (name, recorded, words, options) => {
  const bag = drives.path(`${name}.mcap`);
  await writeMcap(bag, record(drives.drive('poses'), recorded), options);
  drives.refuses(bag, [`${name}.mcap`, ...words]);
};

test('no CameraInfo', () => refusal('no_info', { cameraInfos: false }, ['camera_info']));
test('no tf to the camera', () => refusal('no_tf', { cameraTransforms: false }, ['camera_0_optical_frame']));
test('no LiDAR', () => refusal('no_lidar', { lidars: [] }, ['PointCloud2']));
test('unknown compression', () => refusal('br', {}, ["'br'"], { compression: 'br' }));
test('messages of ROS 1 that are of ROS 2', () => refusal('no_ros1', {}, ['/lidar/points'], ros1Mcap));
test('protobuf', () => refusal('protobuf', {}, ["'protobuf'", 'ROS 2'], { profile: '', messageEncoding: 'protobuf',
  schema: () => ({ encoding: 'protobuf', data: 'descriptor' }) }));

/// A recording that ends early gives the scans up to there, and a warning that says so.
function checkCut(bag, bytes, length, scans) {
  writeFileSync(bag, bytes.subarray(0, length));
  const { status, stderr } = drives.convertWithWarnings(bag, 'cut', '--force');
  assert.equal(status, 0, stderr);
  assert.match(stderr, /cut short/);
  assert.equal(drives.drive('cut').scans.length, scans);
}

test('MCAP cut short', async () => {
  await writeMcap(drives.path('cut.mcap'), plain);
  const bytes = readFileSync(drives.path('cut.mcap')), records = recordsOf(bytes);
  const first = (opcode) => records.find((r) => r.opcode === opcode);
  const middle = ({ begin, end }) => (begin + end) >> 1;
  const chunks = records.filter((r) => r.opcode === opcodes.chunk);
  // Without its first chunk a recording has no scans.
  const places = { nothing: 0, magic: 5, header: middle(first(opcodes.header)),
    length: first(opcodes.chunk).begin + 4, chunk: middle(first(opcodes.chunk)) };
  for (const [place, length] of Object.entries(places)) {
    const bag = drives.path(`cut_${place}.mcap`);
    writeFileSync(bag, bytes.subarray(0, length));
    drives.refuses(bag, [`cut_${place}.mcap`]);
  }
  const bag = drives.path('short.mcap'), all = drives.drive('poses').scans.length;
  checkCut(bag, bytes, first(opcodes.footer).begin, all);
  checkCut(bag, bytes, bytes.length - 3, all);
  checkCut(bag, bytes, middle(chunks.at(-1)), all - 1);
});

test('a bag of ROS 1 cut short, or not closed', () => {
  const bag = drives.path('short.bag'), all = drives.drive('poses').scans.length;
  for (const compression of ['none', 'bz2', 'lz4']) {
    writeRos1Bag(bag, ros1, { compression });
    const bytes = readFileSync(bag), records = ros1BagRecords(bytes);
    const chunks = records.filter(({ operation }) => operation === 5);
    checkCut(bag, bytes, chunks.at(-1).begin + 10, all - 1);
    // Its recorder was killed: the header has no index, the last chunk no size.
    bytes.writeBigUInt64LE(0n, bytes.indexOf('index_pos=') + 'index_pos='.length);
    const { begin, data, size } = chunks.at(-1);
    bytes.writeUInt32LE(0, bytes.indexOf('size=', begin) + 'size='.length);
    bytes.writeUInt32LE(0, data - 4);
    writeFileSync(bag, bytes.subarray(0, data + size));
    const { status, stderr } = drives.convertWithWarnings(bag, 'open', '--force');
    assert.equal(status, 0, stderr);
    assert.match(stderr, compression === 'none' ? /not closed/ : /cut short/);
    assert.equal(drives.drive('open').scans.length, all);
  }
});

test('a chunk whose checksum is another', async () => {
  const bag = drives.path('changed.mcap');
  await writeMcap(bag, plain, { compression: 'none' });
  const bytes = readFileSync(bag), { end } = recordsOf(bytes).find((r) => r.opcode === opcodes.chunk);
  bytes[end - 1000] ^= 1;  // of a scan's points
  writeFileSync(bag, bytes);
  drives.refuses(bag, ['changed.mcap', 'checksum']);
});

test('a database cut short', () => {
  const bag = drives.path('cut_bag');
  writeRosbag2(bag, plain);
  const bytes = readFileSync(`${bag}/cut_bag_0.db3`);
  for (const length of [0, 50, 5000, bytes.length >> 1, bytes.length - 5000]) {
    writeFileSync(`${bag}/cut_bag_0.db3`, bytes.subarray(0, length));
    drives.refuses(bag, ['cut_bag_0.db3']);
  }
});

test('a compressed file, and messages, cut short', () => {
  const bag = drives.path('cut_file');
  writeRosbag2(bag, plain, { compression: 'FILE' });
  const file = `${bag}/cut_file_0.db3.zstd`, bytes = readFileSync(file);
  writeFileSync(file, bytes.subarray(0, bytes.length >> 1));
  drives.refuses(bag, ['cut_file_0.db3.zstd']);
  const half = ({ data }) => data.subarray(0, data.length >> 1);
  const cut = plain.map((message) => ({ ...message, data: half(message) }));
  writeRosbag2(drives.path('cut_messages'), cut);
  drives.refuses(drives.path('cut_messages'), ['/lidar/points']);
});

test('a bag folder without its file, or without its list', () => {
  const bag = drives.path('empty_bag');
  mkdirSync(bag);
  drives.refuses(bag, ['empty_bag']);
  writeRosbag2(drives.path('listed'), plain);
  copyFileSync(drives.path('listed/metadata.yaml'), `${bag}/metadata.yaml`);
  drives.refuses(bag, ['listed_0.db3']);
});

test('other files', () => {
  for (const [name, text, ...words] of [['text.mcap', 'This is a text.\n'], ['text.db3', 'This is a text.\n'],
    ['empty.bag', '#ROSBAG V2.0\nE\0\0\0', 'no scans'], ['old.bag', '#ROSBAG V1.2\n', 'V1.2']]) {
    writeFileSync(drives.path(name), text);
    drives.refuses(drives.path(name), [name, ...words]);
  }
  drives.refuses(drives.path('nowhere.mcap'), ['nowhere.mcap']);
});
