// `fovea map ws://...` of the real drive: the map is that of its files.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';

import { record } from './bags.mjs';
import { BridgeServer } from './bridge_server.mjs';
import { readDrive } from './drive_folder.mjs';
import { programNamedBy } from './test_map.mjs';

const program = programNamedBy('FOVEA_PROGRAM');
const sample = process.env.FOVEA_SAMPLE_DRIVE ?? '';
const isThere = existsSync(sample);
if (!isThere) assert.ok(!process.env.FOVEA_REQUIRE_KITTI, 'the sample drive is missing');

const work = mkdtempSync(join(tmpdir(), 'fovea_live_kitti_'));
after(() => rmSync(work, { recursive: true, force: true }));

/// Poses and points of a map as files of other programs.
function contentOf(map) {
  const poses = join(work, 'poses.csv'), points = join(work, 'points.ply');
  execFileSync(program, ['export', map, poses, '--force', '--format', 'frames']);
  execFileSync(program, ['export', map, points, '--force']);
  return { poses: readFileSync(poses, 'utf8'), points: readFileSync(points) };
}

test('the real drive through a bridge', { skip: !isThere, timeout: 240_000 }, async (t) => {
  const frames = 30, drive = join(work, 'drive');
  execFileSync(programNamedBy('FOVEA_WRITE_GENERIC_DRIVE'), [sample, drive, String(frames)]);
  const fromFiles = join(work, 'files.fovea'), fromBridge = join(work, 'bridge.fovea');
  execFileSync(program, ['map', drive, '-o', fromFiles, '--quiet']);

  const server = await BridgeServer.start(record(readDrive(drive), { images: 'rgb8' }));
  t.after(() => server.close());
  const child = spawn(program, ['map', server.url, '-o', fromBridge, '--every-frame', '--max-wait', '60',
    '--quiet',
    '--report', join(work, 'report.json')], { stdio: ['ignore', 'inherit', 'inherit'] });
  const ended = once(child, 'close');
  await server.play();
  server.close();
  assert.deepEqual(await ended, [0, null]);

  const { map, live } = JSON.parse(readFileSync(join(work, 'report.json'), 'utf8'));
  assert.equal(map.frames, frames);
  assert.equal(map.textures_skipped, 0);
  assert.equal(live.scans, frames);
  assert.equal(live.scans_missing + live.scans_dropped + live.images_late, 0);
  const files = contentOf(fromFiles), bridge = contentOf(fromBridge);
  assert.equal(bridge.poses, files.poses);
  assert.ok(bridge.points.equals(files.points));
});
