import { describe, expect, test } from 'vitest';

import {
  parseFrames, parseFramesFile, parseMapInfo, parseServerStatus, ProtocolError,
} from './protocol';

const pose = [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7];
const map = {
  format: 1, generator: 'fovea 0.1.0', name: 'street', points: 10, colored_points: 9, live: false,
  tileset: 'tiles/tileset.json', frames: 'frames.json', images: true,
  origin: { latitude: 49, longitude: 8.4, altitude: 112.8 }, tile_size: 4, sensor_period: 0.1,
  foveal: { near: 3, far: 18 },
  cameras: [{
    index: 2, width: 10, height: 5, fx: 7, fy: 7, cx: 4.5, cy: 2, T_cam_lidar: pose,
  }],
  rules: ['measured'],
};

describe('map.json', () => {
  test('is taken as it stands', () => {
    const parsed = parseMapInfo(map);
    expect(parsed.coloredPoints).toBe(9);
    expect(parsed.mesh).toBe(false);
    expect(parsed.cameras[0]!.T_cam_lidar).toEqual(pose);
    expect(parsed.foveal).toEqual({ near: 3, far: 18 });
  });

  test('may lack origin, fovea, cameras and tileset', () => {
    const parsed = parseMapInfo(
      { ...map, origin: null, foveal: null, cameras: [], tileset: null, live: true });
    expect(parsed.origin).toBeNull();
    expect(parsed.foveal).toBeNull();
    expect(parsed.tileset).toBeNull();
  });

  test('of another format or without a number it needs is refused by name', () => {
    expect(() => parseMapInfo({ ...map, format: 2 })).toThrow(ProtocolError);
    expect(() => parseMapInfo({ ...map, tile_size: 'four' })).toThrow(/tile_size/);
    expect(() => parseMapInfo(null)).toThrow(ProtocolError);
  });
});

describe('map.json of a city', () => {
  const city = {
    revision: 3, session: 'best', tiles: 15, extent_m: [256, 320],
    drives: [{ name: 'drive_01', length_m: 163.2, frames: 170 }],
  };

  test('has drives, tiles and a revision', () => {
    expect(parseMapInfo(map).city).toBeNull();
    const parsed = parseMapInfo({ ...map, city }).city!;
    expect(parsed.revision).toBe(3);
    expect(parsed.extent).toEqual([256, 320]);
    expect(parsed.drives).toEqual([{ name: 'drive_01', length: 163.2, frames: 170 }]);
  });

  test('without a number it needs is refused by name', () => {
    expect(() => parseMapInfo({ ...map, city: { ...city, tiles: null } })).toThrow(/city.tiles/);
    expect(() => parseMapInfo({ ...map, city: { ...city, extent_m: [1] } })).toThrow(/extent_m/);
  });
});

describe('frames.json', () => {
  const frames = {
    index: [4, 5], time: [0, null], status: ['mapped', 'held-out'], T_local_lidar: [pose, pose],
    score: [null, 14.2], milliseconds: { frame: [90, 95], register: [30, 31] },
  };

  test('of a city has the drive of each frame, and what failed', () => {
    const file = parseFramesFile({ ...frames, drive: [0, 2], failures: ['tile 1,0: damaged'] });
    expect(file.frames.map(({ drive }) => drive)).toEqual([0, 2]);
    expect(file.failures).toEqual(['tile 1,0: damaged']);
    expect(parseFramesFile(frames).failures).toEqual([]);
  });

  test('has a row a frame', () => {
    expect(parseFrames(frames)[1]).toEqual({
      index: 5, time: null, status: 'held-out', T_local_lidar: pose, score: 14.2,
      milliseconds: { frame: 95, register: 31 },
    });
  });

  test('with columns of different lengths is refused', () => {
    expect(() => parseFrames({ ...frames, time: [0] })).toThrow(/time/);
    expect(() => parseFrames({ ...frames, T_local_lidar: [pose, [1, 2]] })).toThrow(/12/);
  });
});

test("the server's status never leaves 0 to 1", () => {
  expect(parseServerStatus({ state: 'reading', read: 7 })).toEqual({ state: 'reading', read: 1, failure: null });
  expect(parseServerStatus({})).toEqual({ state: 'ready', read: 0, failure: null });
  expect(parseServerStatus({ state: 'reading', failure: 'torn' }).failure).toBe('torn');
});
