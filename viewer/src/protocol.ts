// What the server says over HTTP (docs/viewer-protocol.md), checked where it comes in.
import type { Intrinsics } from './intrinsics';

/** A 3x4 matrix row by row, `T_to_from`. */
export type Pose = readonly number[];

export interface CameraInfo extends Intrinsics {
  readonly index: number;
  readonly T_cam_lidar: Pose;
}

export interface GeodeticPoint {
  readonly latitude: number;
  readonly longitude: number;
  readonly altitude: number;
}

export interface DriveInfo {
  readonly name: string;
  /** m */
  readonly length: number;
  readonly frames: number;
}

/** What a city has instead of one drive. */
export interface CityInfo {
  readonly revision: number;
  readonly session: string;
  readonly tiles: number;
  /** Of all tiles, to the east and to the north (m). */
  readonly extent: readonly [number, number];
  readonly drives: readonly DriveInfo[];
}

export interface MapInfo {
  readonly generator: string;
  readonly name: string;
  readonly points: number;
  readonly coloredPoints: number;
  readonly live: boolean;
  /** Its tiles have triangles instead of points. */
  readonly mesh: boolean;
  readonly tileset: string | null;
  readonly frames: string;
  /** Tells how far the server has read the map; null: there is no such thing. */
  readonly status: string | null;
  readonly images: boolean;
  readonly origin: GeodeticPoint | null;
  readonly tileSize: number;
  readonly sensorPeriod: number;
  readonly foveal: { readonly near: number; readonly far: number } | null;
  readonly cameras: readonly CameraInfo[];
  readonly rules: readonly string[];
  /** null: this is a map. */
  readonly city: CityInfo | null;
}

export type FrameStatus = 'mapped' | 'held-out' | 'skipped';

/** A frame of the drive. `milliseconds` are by stage; `frame` is the whole of it. */
export interface Frame {
  readonly index: number;
  readonly time: number | null;
  readonly status: FrameStatus;
  readonly T_local_lidar: Pose;
  readonly score: number | null;
  readonly milliseconds: Readonly<Record<string, number>>;
  /** Number of its drive. */
  readonly drive?: number;
}

export interface FramesFile {
  readonly frames: Frame[];
  /** A line for each part of a city that cannot be read. */
  readonly failures: readonly string[];
}

export interface ServerStatus {
  /** What of the map cannot be read. */
  readonly failure: string | null;
  readonly state: 'reading' | 'ready';
  readonly read: number;
}

/** The server sent something else than the protocol says. */
export class ProtocolError extends Error {}

type Json = Record<string, unknown>;

function isObject(value: unknown): value is Json {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

function asObject(value: unknown, what: string): Json {
  if (!isObject(value)) throw new ProtocolError(`${what} is not an object`);
  return value;
}

function asNumber(value: unknown, what: string): number {
  if (typeof value !== 'number' || !Number.isFinite(value)) {
    throw new ProtocolError(`${what} is not a number`);
  }
  return value;
}

function asArray(value: unknown, what: string): unknown[] {
  if (!Array.isArray(value)) throw new ProtocolError(`${what} is not a list`);
  return value;
}

function asNumberOrNull(value: unknown): number | null {
  return typeof value === 'number' && Number.isFinite(value) ? value : null;
}

export function parsePose(value: unknown, what: string): Pose {
  const pose = asArray(value, what);
  if (pose.length !== 12) throw new ProtocolError(`${what} has ${pose.length} numbers, not 12`);
  return pose.map((number) => asNumber(number, what));
}

function parseCamera(value: unknown): CameraInfo {
  const camera = asObject(value, 'a camera');
  const number = (key: string) => asNumber(camera[key], `a camera's ${key}`);
  return {
    index: number('index'),
    width: number('width'),
    height: number('height'),
    fx: number('fx'),
    fy: number('fy'),
    cx: number('cx'),
    cy: number('cy'),
    T_cam_lidar: parsePose(camera.T_cam_lidar, "a camera's T_cam_lidar"),
  };
}

function parseCity(value: unknown): CityInfo | null {
  if (!isObject(value)) return null;
  const number = (of: Json, key: string) => asNumber(of[key], `map.json: city.${key}`);
  const extent = asArray(value.extent_m, 'map.json: city.extent_m');
  const metres = (i: number) => asNumber(extent[i], 'map.json: city.extent_m');
  return {
    revision: number(value, 'revision'),
    session: String(value.session ?? ''),
    tiles: number(value, 'tiles'),
    extent: [metres(0), metres(1)],
    drives: asArray(value.drives, 'map.json: city.drives').map((drive) => {
      const of = asObject(drive, 'a drive of the city');
      return { name: String(of.name), length: number(of, 'length_m'), frames: number(of, 'frames') };
    }),
  };
}

export function parseMapInfo(value: unknown): MapInfo {
  const map = asObject(value, 'map.json');
  if (map.format !== 1) {
    throw new ProtocolError(`map.json has format ${String(map.format)}, this page knows 1`);
  }
  const number = (of: Json, key: string) => asNumber(of[key], `map.json: ${key}`);
  const origin = isObject(map.origin) ? map.origin : null;
  const foveal = isObject(map.foveal) ? map.foveal : null;
  return {
    generator: String(map.generator ?? 'fovea'),
    name: String(map.name ?? 'map'),
    points: number(map, 'points'),
    coloredPoints: number(map, 'colored_points'),
    live: map.live === true,
    mesh: map.mesh === true,
    tileset: typeof map.tileset === 'string' ? map.tileset : null,
    frames: String(map.frames ?? 'frames.json'),
    status: typeof map.status === 'string' ? map.status : null,
    images: map.images === true,
    origin: origin && {
      latitude: number(origin, 'latitude'),
      longitude: number(origin, 'longitude'),
      altitude: number(origin, 'altitude'),
    },
    tileSize: number(map, 'tile_size'),
    sensorPeriod: number(map, 'sensor_period'),
    foveal: foveal && { near: number(foveal, 'near'), far: number(foveal, 'far') },
    cameras: asArray(map.cameras ?? [], 'map.json: cameras').map(parseCamera),
    rules: asArray(map.rules ?? [], 'map.json: rules').map(String),
    city: parseCity(map.city),
  };
}

export function parseStatus(value: unknown): FrameStatus {
  if (value === 'mapped' || value === 'held-out' || value === 'skipped') return value;
  throw new ProtocolError(`a frame's status is ${String(value)}`);
}

export function parseMilliseconds(value: unknown): Record<string, number> {
  const stages: Record<string, number> = {};
  for (const [stage, time] of Object.entries(isObject(value) ? value : {})) {
    if (typeof time === 'number' && Number.isFinite(time)) stages[stage] = time;
  }
  return stages;
}

/** frames.json: a column each, all of one length. */
export function parseFrames(value: unknown): Frame[] {
  const columns = asObject(value, 'frames.json');
  const index = asArray(columns.index, 'frames.json: index');
  const column = (key: string) => {
    const list = asArray(columns[key], `frames.json: ${key}`);
    if (list.length !== index.length) {
      throw new ProtocolError(`frames.json: ${key} has ${list.length} rows, index ${index.length}`);
    }
    return list;
  };
  const [time, status, poses] = [column('time'), column('status'), column('T_local_lidar')];
  const score = columns.score === undefined ? [] : column('score');
  const drives = columns.drive === undefined ? null : column('drive');
  const stages = Object.entries(isObject(columns.milliseconds) ? columns.milliseconds : {})
    .filter((entry): entry is [string, unknown[]] => Array.isArray(entry[1]));
  return index.map((number, row) => ({
    index: asNumber(number, 'frames.json: index'),
    time: asNumberOrNull(time[row]),
    status: parseStatus(status[row]),
    T_local_lidar: parsePose(poses[row], 'frames.json: T_local_lidar'),
    score: asNumberOrNull(score[row]),
    milliseconds: parseMilliseconds(
      Object.fromEntries(stages.map(([stage, times]) => [stage, times[row]]))),
    ...(drives && { drive: asNumber(drives[row], 'frames.json: drive') }),
  }));
}

export function parseFramesFile(value: unknown): FramesFile {
  const failures = asObject(value, 'frames.json').failures ?? [];
  return {
    frames: parseFrames(value),
    failures: asArray(failures, 'frames.json: failures').map(String),
  };
}

export function parseServerStatus(value: unknown): ServerStatus {
  const status = asObject(value, 'status.json');
  return {
    state: status.state === 'reading' ? 'reading' : 'ready',
    failure: typeof status.failure === 'string' ? status.failure : null,
    read: Math.min(1, Math.max(0, asNumberOrNull(status.read) ?? 0)),
  };
}
