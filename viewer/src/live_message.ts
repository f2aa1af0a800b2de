// What the server sends while a map grows (docs/viewer-protocol.md). Nothing here throws: a message
// that is cut short or odd is null.

import {
  parseFrames, parseMilliseconds, parsePose, parseStatus, type Frame, type Pose,
} from './protocol';

export interface HelloMessage {
  readonly type: 'hello';
  readonly session: string;
  readonly frames: Frame[];
  readonly T_local_submap: Pose[];
  readonly done: number;
  readonly total: number;
}

export interface FrameMessage {
  readonly type: 'frame';
  readonly frame: Frame;
  readonly points: number;
  readonly done: number;
  readonly total: number;
  readonly late: boolean;
  readonly lateFrames: number;
  readonly mappedAt: number | null;
}

export interface PosesMessage {
  readonly type: 'poses';
  readonly T_local_submap: ReadonlyMap<number, Pose>;
  readonly T_local_lidar: ReadonlyMap<number, Pose>;
}

export interface EndMessage {
  readonly type: 'end';
}

/** The points of a tile, or more of them; views into the message. */
export interface TileSection {
  readonly submap: number;
  readonly tile: readonly [number, number, number];
  readonly whole: boolean;
  readonly count: number;
  /** Millimetres from the tile's lowest corner, x y z. */
  readonly position: Uint16Array;
  /** Red, green, blue and camera. */
  readonly color: Uint8Array;
  /** Rule, views, spread and 0. */
  readonly source: Uint8Array;
  readonly frame: Float32Array;
  /** Range and incidence. */
  readonly sight: Uint16Array;
}

export interface PointsMessage {
  readonly type: 'points';
  readonly frame: number;
  readonly sections: TileSection[];
}

export interface ImageMessage {
  readonly type: 'image';
  readonly frame: number;
  readonly camera: number;
  readonly jpeg: Uint8Array<ArrayBuffer>;
}

export type TextMessage = HelloMessage | FrameMessage | PosesMessage | EndMessage;
export type BinaryMessage = PointsMessage | ImageMessage;
export type LiveMessage = TextMessage | BinaryMessage;

type Json = Record<string, unknown>;

function count(value: unknown): number {
  return typeof value === 'number' && Number.isFinite(value) ? value : 0;
}

function posesByNumber(value: unknown): Map<number, Pose> {
  const poses = new Map<number, Pose>();
  for (const [key, pose] of Object.entries((value ?? {}) as Json)) {
    poses.set(Number(key), parsePose(pose, 'a pose'));
  }
  return poses;
}

function textMessage(json: Json): TextMessage | null {
  switch (json.type) {
    case 'hello': {
      if (typeof json.session !== 'string' || !Array.isArray(json.T_local_submap)) return null;
      return {
        type: 'hello',
        session: json.session,
        frames: parseFrames(json.frames),
        T_local_submap: json.T_local_submap.map((pose) => parsePose(pose, 'a submap')),
        done: count(json.done),
        total: count(json.total),
      };
    }
    case 'frame': {
      if (typeof json.index !== 'number') return null;
      return {
        type: 'frame',
        frame: {
          index: json.index,
          time: typeof json.time === 'number' ? json.time : null,
          status: parseStatus(json.status),
          T_local_lidar: parsePose(json.T_local_lidar, 'a frame'),
          score: typeof json.score === 'number' ? json.score : null,
          milliseconds: parseMilliseconds(json.milliseconds),
        },
        points: count(json.points),
        done: count(json.done),
        total: count(json.total),
        late: json.late === true,
        lateFrames: count(json.late_frames),
        mappedAt: typeof json.mapped_at === 'number' ? json.mapped_at : null,
      };
    }
    case 'poses':
      return {
        type: 'poses',
        T_local_submap: posesByNumber(json.T_local_submap),
        T_local_lidar: posesByNumber(json.T_local_lidar),
      };
    case 'end': return { type: 'end' };
    default: return null;
  }
}

export function parseText(text: string): TextMessage | null {
  try {
    const json: unknown = JSON.parse(text);
    return typeof json === 'object' && json !== null ? textMessage(json as Json) : null;
  } catch {
    return null;
  }
}

/** Reads little-endian numbers in order and knows when there are too few bytes. */
class Reader {
  private at = 0;
  private readonly view: DataView;

  constructor(private readonly buffer: ArrayBuffer) {
    this.view = new DataView(buffer);
  }

  get left(): number {
    return this.buffer.byteLength - this.at;
  }

  u32(): number {
    this.at += 4;
    return this.view.getUint32(this.at - 4, true);
  }

  i32(): number {
    this.at += 4;
    return this.view.getInt32(this.at - 4, true);
  }

  /** Where the next `bytes` begin. */
  skip(bytes: number): number {
    this.at += bytes;
    return this.at - bytes;
  }
}

const headerBytes = 24;
const pointBytes = 4 + 4 + 4 + 4;  // color, source, frame, sight: beside the position

function positionBytes(points: number): number {
  return Math.ceil(6 * points / 4) * 4;
}

function section(buffer: ArrayBuffer, reader: Reader): TileSection | null {
  if (reader.left < headerBytes) return null;
  const submap = reader.u32();
  const tile = [reader.i32(), reader.i32(), reader.i32()] as const;
  const whole = reader.u32();
  const n = reader.u32();
  if (whole > 1 || reader.left < positionBytes(n) + pointBytes * n) return null;
  return {
    submap, tile, whole: whole === 1, count: n,
    position: new Uint16Array(buffer, reader.skip(positionBytes(n)), 3 * n),
    color: new Uint8Array(buffer, reader.skip(4 * n), 4 * n),
    source: new Uint8Array(buffer, reader.skip(4 * n), 4 * n),
    frame: new Float32Array(buffer, reader.skip(4 * n), n),
    sight: new Uint16Array(buffer, reader.skip(4 * n), 2 * n),
  };
}

/** All machines that run browsers are little-endian, as the message is: its arrays are used as they
 * stand. */
export function parseBinary(buffer: ArrayBuffer): BinaryMessage | null {
  const reader = new Reader(buffer);
  if (reader.left < 12) return null;
  const kind = reader.u32();
  const frame = reader.i32();
  const third = reader.u32();
  if (kind === 2) {
    if (reader.left === 0) return null;
    return { type: 'image', frame, camera: third, jpeg: new Uint8Array(buffer, 12) };
  }
  if (kind !== 1) return null;
  const sections: TileSection[] = [];
  for (let i = 0; i < third; ++i) {
    const next = section(buffer, reader);
    if (!next) return null;
    sections.push(next);
  }
  return reader.left === 0 ? { type: 'points', frame, sections } : null;
}
