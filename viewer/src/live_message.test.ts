import { describe, expect, test } from 'vitest';

import { parseBinary, parseText, type ImageMessage, type PointsMessage } from './live_message';

const pose = [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7];

class Writer {
  readonly bytes: number[] = [];

  u8(...values: number[]): this {
    this.bytes.push(...values.map((value) => value & 255));
    return this;
  }

  u16(...values: number[]): this {
    for (const value of values) this.u8(value, value >> 8);
    return this;
  }

  u32(...values: number[]): this {
    for (const value of values) this.u8(value, value >> 8, value >> 16, value >> 24);
    return this;
  }

  f32(...values: number[]): this {
    for (const value of values) this.u8(...new Uint8Array(new Float32Array([value]).buffer));
    return this;
  }

  get buffer(): ArrayBuffer {
    return new Uint8Array(this.bytes).buffer;
  }
}

/** Sections of one point (a padded position) and of two. */
function points(): Writer {
  const writer = new Writer().u32(1, 120, 2);
  writer.u32(3, -1, 2, 0, 1, 1).u16(10, 20, 30, 0).u8(1, 2, 3, 255).u8(129, 4, 5, 0)
    .f32(119).u16(1234, 65535);
  writer.u32(0, 7, 8, 9, 0, 2).u16(1, 2, 3, 4, 5, 6).u8(9, 9, 9, 2, 8, 8, 8, 2)
    .u8(0, 1, 2, 0, 0, 1, 2, 0).f32(120, 120).u16(1, 2, 3, 4);
  return writer;
}

describe('points', () => {
  test('come in sections', () => {
    const message = parseBinary(points().buffer) as PointsMessage;
    expect(message.frame).toBe(120);
    const [one, two] = message.sections;
    expect(one).toMatchObject({ submap: 3, tile: [-1, 2, 0], whole: true, count: 1 });
    expect([...one!.position]).toEqual([10, 20, 30]);
    expect([...one!.color]).toEqual([1, 2, 3, 255]);
    expect([...one!.source]).toEqual([129, 4, 5, 0]);
    expect([...one!.frame]).toEqual([119]);
    expect([...one!.sight]).toEqual([1234, 65535]);
    expect(two).toMatchObject({ submap: 0, tile: [7, 8, 9], whole: false, count: 2 });
    expect([...two!.position]).toEqual([1, 2, 3, 4, 5, 6]);
    expect([...two!.sight]).toEqual([1, 2, 3, 4]);
  });

  test('cut short anywhere are no message', () => {
    const { bytes } = points();
    for (let length = 0; length < bytes.length; ++length) {
      expect(parseBinary(new Uint8Array(bytes.slice(0, length)).buffer)).toBeNull();
    }
  });

  test('with something behind them are no message', () => {
    expect(parseBinary(points().u8(0).buffer)).toBeNull();
  });

  test('of a tile that claims billions are no message', () => {
    const claim = new Writer().u32(1, 0, 1).u32(0, 0, 0, 0, 0, 0xffffffff);
    expect(parseBinary(claim.buffer)).toBeNull();
    expect(parseBinary(new Writer().u32(1, 0, 0xffffffff).buffer)).toBeNull();
  });

  test('may be none: a tile that has gone', () => {
    const gone = new Writer().u32(1, -1, 1).u32(0, 0, 0, 0, 1, 0);
    const message = parseBinary(gone.buffer) as PointsMessage;
    expect(message.frame).toBe(-1);
    expect(message.sections[0]).toMatchObject({ whole: true, count: 0 });
  });
});

test('an image is the bytes behind its header', () => {
  const message = parseBinary(new Writer().u32(2, 12, 3).u8(255, 216).buffer) as ImageMessage;
  expect(message).toMatchObject({ type: 'image', frame: 12, camera: 3 });
  expect([...message.jpeg]).toEqual([255, 216]);
  expect(parseBinary(new Writer().u32(2, 12, 3).buffer)).toBeNull();
});

test('another kind is no message', () => {
  expect(parseBinary(new Writer().u32(9, 0, 0).buffer)).toBeNull();
});

describe('text', () => {
  test('a frame', () => {
    const text = JSON.stringify({
      type: 'frame', index: 7, time: 0.7, status: 'mapped', T_local_lidar: pose,
      milliseconds: { frame: 80 }, score: null, points: 100, done: 8, total: 51, late: true,
      late_frames: 2, mapped_at: 1e12,
    });
    expect(parseText(text)).toMatchObject({
      type: 'frame', late: true, lateFrames: 2, mappedAt: 1e12, points: 100,
      frame: { index: 7, score: null, milliseconds: { frame: 80 } },
    });
  });

  test('hello', () => {
    const text = JSON.stringify({
      type: 'hello', session: 'a', T_local_submap: [pose], done: 1, total: 2,
      frames: { index: [0], time: [0], status: ['mapped'], T_local_lidar: [pose], score: [null] },
    });
    expect(parseText(text)).toMatchObject({ type: 'hello', session: 'a', done: 1, total: 2 });
  });

  test('poses by number', () => {
    const message = parseText(
      JSON.stringify({ type: 'poses', T_local_submap: { 3: pose }, T_local_lidar: { 120: pose } }));
    expect(message).toEqual({
      type: 'poses', T_local_submap: new Map([[3, pose]]), T_local_lidar: new Map([[120, pose]]),
    });
  });

  test('that makes no sense is no message', () => {
    const odd = [
      '', '{', 'null', '[]', '7', '{"type":"other"}', '{"type":"frame"}', '{"type":"hello"}',
      '{"type":"poses","T_local_submap":{"1":[1,2]}}',
      '{"type":"frame","index":1,"status":"mapped","T_local_lidar":"no"}',
    ];
    for (const text of odd) expect(parseText(text)).toBeNull();
  });

  test('the end', () => {
    expect(parseText('{"type":"end"}')).toEqual({ type: 'end' });
  });
});
