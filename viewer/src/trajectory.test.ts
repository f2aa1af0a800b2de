import { Vector3 } from 'three';
import { describe, expect, test } from 'vitest';

import type { Frame } from './protocol';
import { Trajectory } from './trajectory';

function frame(index: number, x: number, time: number | null): Frame {
  return {
    index, time, status: 'mapped', T_local_lidar: [1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0],
    score: null, milliseconds: {},
  };
}

describe('a trajectory', () => {
  const drive = new Trajectory([frame(10, 0, 0), frame(11, 2, 0.1), frame(13, 6, 0.3)]);

  test('is straight between frames and ends at its ends', () => {
    const x = (row: number) => new Vector3().setFromMatrixPosition(drive.poseAt(row)).x;
    expect(x(0.5)).toBeCloseTo(1, 12);
    expect(x(1.25)).toBeCloseTo(3, 12);
    expect(x(-3)).toBe(0);
    expect(x(99)).toBe(6);
  });

  test('knows frames by number', () => {
    expect(drive.row(13)).toBe(2);
    expect(drive.row(12)).toBeUndefined();
    expect(drive.nearestRow(12)).toBe(1);
    expect(drive.nearestRow(1000)).toBe(2);
  });

  test('is played by its stamps', () => {
    expect(drive.rowAfter(0, 0.05, 1)).toBeCloseTo(0.5, 9);
    expect(drive.rowAfter(0, 0.2, 1)).toBeCloseTo(1.5, 9);
    expect(drive.rowAfter(1.5, 5, 1)).toBe(2);
  });

  test("without stamps it is played by the sensor's period", () => {
    const bare = new Trajectory([frame(0, 0, null), frame(1, 1, null)]);
    expect(bare.rowAfter(0, 0.05, 0.1)).toBeCloseTo(0.5, 9);
  });

  test('takes a newer word on a frame', () => {
    const grown = new Trajectory([frame(0, 0, 0)]);
    grown.put(frame(1, 1, 0.1));
    grown.put({ ...frame(1, 1, 0.1), status: 'held-out' });
    grown.movePose(1, frame(1, 5, 0).T_local_lidar);
    expect(grown.length).toBe(2);
    expect(grown.frame(1)!.status).toBe('held-out');
    expect(grown.position(1).x).toBe(5);
    grown.movePose(77, frame(0, 0, 0).T_local_lidar);
    expect(grown.length).toBe(2);
  });

  test('may be empty', () => {
    const empty = new Trajectory();
    expect(empty.rowAfter(0, 1, 0.1)).toBe(0);
    expect(empty.poseAt(3).elements[0]).toBe(1);
  });
});
