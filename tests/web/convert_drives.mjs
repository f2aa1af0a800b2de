// Small simulated drives with the navigation that a case needs, and what Fovea makes of their recordings.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { readDrive, readTable } from './drive_folder.mjs';
import { programNamedBy } from './test_map.mjs';

const smallCameras = ['camera.width=480', 'camera.height=160', 'camera.focal=270', 'camera.cx=238.5',
  'camera.cy=72.25'];

const multiply = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz];
const inverse = ([x, y, z, w]) => [-x, -y, -z, w];
const turn = (q, v) => multiply(multiply(q, [...v, 0]), inverse(q)).slice(0, 3);
const about = (axis, angle) => {
  const q = [0, 0, 0, Math.cos(angle / 2)];
  q[axis] = Math.sin(angle / 2);
  return q;
};

/// Of three rows of four numbers.
function quaternionOf(m) {
  const root = (a, b, c) => Math.sqrt(Math.max(0, 1 + a * m[0] + b * m[5] + c * m[10]));
  const signed = (value, sign) => (sign < 0 ? -value : value);
  const q = [signed(root(1, -1, -1), m[9] - m[6]), signed(root(-1, 1, -1), m[2] - m[8]),
    signed(root(-1, -1, 1), m[4] - m[1]), root(1, 1, 1)];
  return q.map((value) => value / Math.hypot(...q));
}

/// poses.csv instead of gnss.csv, from the true poses of the LiDAR.
function writePoses(folder) {
  const { body: { T_body_lidar: T }, scans } = readDrive(folder);
  const truth = readFileSync(join(folder, 'truth/poses.txt'), 'utf8').trim().split('\n');
  const lines = truth.map((line, i) => {
    const m = line.split(' ').map(Number);
    const rotation = multiply(quaternionOf(m), inverse(T.rotation));
    const lever = turn(rotation, T.translation);
    return [scans[i].time, ...lever.map((value, axis) => m[4 * axis + 3] - value), ...rotation].join(',');
  });
  writeFileSync(join(folder, 'poses.csv'), `time_ns,x,y,z,qx,qy,qz,qw\n${lines.join('\n')}\n`);
  rmSync(join(folder, 'gnss.csv'));
}

/// The attitudes of gnss.csv as those of an IMU that is turned against the body.
function moveAttitudes(folder) {
  const R_body_imu = about(2, 0.3);
  const rows = readTable(join(folder, 'gnss.csv'));
  const inertia = rows.map(({ time, roll, pitch, yaw }) => {
    const R_enu_body = multiply(multiply(about(2, yaw), about(1, pitch)), about(0, roll));
    return [time, ...multiply(R_enu_body, R_body_imu), 0.01, -0.02, 0.03, 0.4, -0.1, 9.8].join(',');
  });
  writeFileSync(join(folder, 'imu.csv'), `time_ns,qx,qy,qz,qw,wx,wy,wz,ax,ay,az\n${inertia.join('\n')}\n`);
  const columns = ['time_ns', 'latitude', 'longitude', 'altitude', 'accuracy'];
  const lines = rows.map((row) => columns.map((name) => row[name]).join(','));
  writeFileSync(join(folder, 'gnss.csv'), `${columns.join(',')}\n${lines.join('\n')}\n`);
  const toml = join(folder, 'drive.toml');
  const T_body_imu = `T_body_imu = {translation = [0, 0, 0], rotation = [${R_body_imu.join(', ')}]}`;
  writeFileSync(toml, readFileSync(toml, 'utf8').replace(/^T_body_imu = .*$/m, T_body_imu)
    .replace(/^antenna = .*$/m, 'antenna = [-0.31, 0.02, 0.57]'));
}

const rewrite = { poses: writePoses, gnss: moveAttitudes };

/// All of them are called "drive", each in a folder of its own: a map's digest is of that name, too.
export class ConvertDrives {
  root = mkdtempSync(join(tmpdir(), 'fovea_convert_'));
  #program = programNamedBy('FOVEA_PROGRAM');
  #frames;

  constructor({ frames = 4 } = {}) {
    this.#frames = frames;
  }

  path(...names) {
    return join(this.root, ...names);
  }

  simulate(name, ...settings) {
    mkdirSync(this.path(name));
    execFileSync(this.#program, ['simulate', '-o', this.path(name, 'drive'), '--format', 'generic',
      '--seed', '3', '--quiet', ...[...smallCameras, ...settings].flatMap((setting) => ['--set', setting]), '--frames', `${this.#frames}`]);
  }

  /// A simulated drive again, with other navigation.
  /// @param navigation  "poses": poses.csv; "gnss": gnss.csv without attitudes, imu.csv with them
  derive(from, name, navigation) {
    cpSync(this.path(from), this.path(name), { recursive: true });
    rewrite[navigation](this.path(name, 'drive'));
  }

  drive(name) {
    return readDrive(this.path(name, 'drive'));
  }

  /// The digest of the map of a drive. The rates of its IMU are made up, so they are not used.
  digest(name) {
    const map = this.path(name, 'map.fovea'), cameras = this.drive(name).cameras.map(({ index }) => index);
    execFileSync(this.#program,
      ['map', this.path(name, 'drive'), '-o', map, '--quiet', '--no-imu', '--cameras', cameras.join()]);
    return execFileSync(this.#program, ['info', '--digest', map], { encoding: 'utf8' });
  }

  /// `fovea convert` of a recording to the drive `name`: {status, stderr}.
  convert(recording, name, ...options) {
    return this.convertWithWarnings(recording, name, '--quiet', ...options);
  }

  convertWithWarnings(recording, name, ...options) {
    mkdirSync(this.path(name), { recursive: true });
    return spawnSync(this.#program, ['convert', recording, '-o', this.path(name, 'drive'), ...options],
      { encoding: 'utf8' });
  }

  /// `fovea convert --list`: {status, stdout}.
  list(recording) {
    return spawnSync(this.#program, ['convert', '--list', recording], { encoding: 'utf8' });
  }

  /// It ends with one line that says all of `words`, and leaves nothing.
  refuses(recording, words, ...options) {
    const { status, stderr } = this.convert(recording, 'refused', ...options);
    assert.equal(status, 1, stderr);
    assert.match(stderr, /^fovea: error: [^\n]+\n$/);
    for (const word of words) assert.ok(stderr.includes(word), `"${word}" is not in: ${stderr}`);
    for (const name of ['drive', 'drive.partial']) assert.ok(!existsSync(this.path('refused', name)), name);
  }

  remove() {
    rmSync(this.root, { recursive: true });
  }
}
