// Reads the folder of docs/drives.md, as the simulator and `fovea convert` write it.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

import { parse } from 'smol-toml';

/// Lines of a table: objects of the columns' texts, `time` in nanoseconds with all their digits.
export function readTable(path) {
  if (!existsSync(path)) return [];
  const [names, ...lines] = readFileSync(path, 'utf8').trim().split('\n').map((line) => line.split(','));
  return lines.map((cells) => {
    const row = Object.fromEntries(names.map((name, i) => [name, cells[i]]));
    return { ...row, time: BigInt(row.time_ns) };
  });
}

export function numberOf(text) {
  return text === 'inf' ? Infinity : Number(text);
}

/// The numbered files of a folder with their stamps, in order.
function stampedFiles(folder) {
  const files = new Map(readdirSync(folder).map((name) => [Number.parseInt(name, 10), join(folder, name)]));
  return readTable(join(folder, 'stamps.csv'))
    .map(({ index, time }) => ({ time, path: files.get(Number(index)) }));
}

/// Of several LiDARs, the one whose frame is that of the drive first.
function lidarsOf(folder, tables) {
  const named = Object.entries(tables).filter(([, values]) => typeof values === 'object');
  if (named.length === 0) return [{ name: '', scans: stampedFiles(join(folder, 'lidar')) }];
  return named.map(([name, { T_lidar_sensor: T }]) => (
    { name, T_lidar_sensor: T, scans: stampedFiles(join(folder, 'lidar', name)) }))
    .sort((a, b) => Boolean(a.T_lidar_sensor) - Boolean(b.T_lidar_sensor));
}

export function readDrive(folder) {
  const { body, camera, lidar } = parse(readFileSync(join(folder, 'drive.toml'), 'utf8'));
  const lidars = lidarsOf(folder, lidar);
  return {
    body,
    lidars,
    cameras: Object.entries(camera).map(([name, values]) => (
      { ...values, name, images: stampedFiles(join(folder, 'images', name)) })),
    scans: lidars[0].scans,
    poses: readTable(join(folder, 'poses.csv')),
    positions: readTable(join(folder, 'gnss.csv')),
    inertia: readTable(join(folder, 'imu.csv')),
  };
}

/// A binary PCD file of float32 fields: their names, and the points' bytes.
export function readScan(path) {
  const bytes = readFileSync(path);
  const begin = bytes.indexOf('DATA binary\n') + 'DATA binary\n'.length;
  const header = Object.fromEntries(bytes.subarray(0, begin).toString().split('\n')
    .map((line) => [line.split(' ')[0], line.split(' ').slice(1)]));
  assert.ok(header.TYPE.every((type) => type === 'F') && header.SIZE.every((size) => size === '4'), path);
  return { names: header.FIELDS, count: Number(header.POINTS[0]), data: bytes.subarray(begin) };
}
