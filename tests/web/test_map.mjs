// A small map, what its exports must hold, and the exports, made by the built program.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export function programNamedBy(variable) {
  const program = process.env[variable];
  assert.ok(program, `${variable} must name the built program`);
  return program;
}

export const origin = { latitude: 49.011212804408, longitude: 8.4228850417969, altitude: 112.83492279053 };
// 26 September 2011, 14:14:13 UTC, as GPS seconds less 1e9: 15 leap seconds.
export const firstGpsTime = 1317046453 - 315964800 + 15 - 1e9;

export class TestMap {
  constructor() {
    this.folder = mkdtempSync(join(tmpdir(), 'fovea_web_'));
    execFileSync(programNamedBy('FOVEA_WRITE_TEST_MAP'), [this.folder]);
    this.points = JSON.parse(readFileSync(join(this.folder, 'points.json'), 'utf8'));
    assert.ok(this.points.length > 2000);
  }

  /// Path of the export.
  export(name, ...options) {
    return this.exportOf('map.fovea', name, ...options);
  }

  /// The same of another of the maps.
  exportOf(map, name, ...options) {
    const output = join(this.folder, name);
    const command = ['export', join(this.folder, map), output, '--force', '--quiet'];
    execFileSync(programNamedBy('FOVEA_PROGRAM'), [...command, ...options]);
    return output;
  }

  remove() {
    rmSync(this.folder, { recursive: true });
  }
}

/// An ArrayBuffer of a file.
export function bytesOf(path) {
  const bytes = readFileSync(path);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
}

/// Earth-centred coordinates of a point of the local frame, by the textbooks' formulas.
export function ecefOfLocal([east, north, up]) {
  const a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f);
  const phi = (origin.latitude * Math.PI) / 180, lambda = (origin.longitude * Math.PI) / 180;
  const [sp, cp, sl, cl] = [Math.sin(phi), Math.cos(phi), Math.sin(lambda), Math.cos(lambda)];
  const n = a / Math.sqrt(1 - e2 * sp * sp);
  return [
    (n + origin.altitude) * cp * cl - sl * east - sp * cl * north + cp * cl * up,
    (n + origin.altitude) * cp * sl + cl * east - sp * sl * north + cp * sl * up,
    (n * (1 - e2) + origin.altitude) * sp + cp * north + sp * up,
  ];
}

export function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Light, 0 to 1, of an sRGB channel, 0 to 255 (IEC 61966-2-1).
export function light(channel) {
  const s = channel / 255;
  return s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4;
}
