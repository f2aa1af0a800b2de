// Messages of ROS 2 (Humble) as CDR, and of ROS 1, by encoders and definitions of other people.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';

import rosmsg from '@foxglove/rosmsg';
import { MessageWriter as Ros1Writer } from '@foxglove/rosmsg-serialization';
import { MessageWriter as Ros2Writer } from '@foxglove/rosmsg2-serialization';
import { PNG } from 'pngjs';

const folder = join(dirname(createRequire(import.meta.url).resolve('@foxglove/rosmsg-msgs-common')), '../msgdefs');
const time = `${'='.repeat(80)}\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n`;

/// Of the driver livox_ros_driver2.
export const livoxType = 'livox_ros_driver2/msg/CustomMsg';
const livoxSchema = `std_msgs/Header header
uint64 timebase
uint32 point_num
uint8 lidar_id
uint8[3] rsvd
CustomPoint[] points
${'='.repeat(80)}
MSG: livox_ros_driver2/CustomPoint
uint32 offset_time
float32 x
float32 y
float32 z
uint8 reflectivity
uint8 tag
uint8 line
${'='.repeat(80)}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
`;

/// The definition of "sensor_msgs/msg/Imu" in ROS 2: its text, and those of the types in it.
export function schemaOf(type) {
  if (type === livoxType) return livoxSchema + time;
  return readFileSync(join(folder, 'ros2humble', `${type}.msg`), 'utf8') + time;
}

/// "sensor_msgs/Imu" of ROS 1.
export const ros1Type = (type) => type.replace('/msg/', '/');
export function ros1SchemaOf(type) {
  return readFileSync(join(folder, 'ros1', `${ros1Type(type)}.msg`), 'utf8');
}

const writers = new Map();

function writerOf(type, make) {
  if (!writers.has(type)) writers.set(type, make());
  return writers.get(type);
}

export function encode(type, message) {
  const make = () => new Ros2Writer(rosmsg.parse(schemaOf(type), { ros2: true }));
  return writerOf(type, make).writeMessage(message);
}

/// The fields that ROS 1 names differently.
const ros1Names = { nanosec: 'nsec', d: 'D', k: 'K', r: 'R', p: 'P' };

function withRos1Names(value) {
  if (Array.isArray(value)) return value.map(withRos1Names);
  if (value === null || typeof value !== 'object' || ArrayBuffer.isView(value)) return value;
  return Object.fromEntries(Object.entries(value).map(([name, part]) =>
    [ros1Names[name] ?? name, withRos1Names(part)]));
}

/// The message with all arrays and parts that it leaves out: zeros.
function completed(message, definitions, type) {
  const { definitions: fields } = definitions.find(({ name }) => name === type);
  const parts = fields.filter(({ isComplex, isArray }) => isComplex || isArray).map((field) => {
    const { name, type: part, isArray, isComplex, arrayLength = 0 } = field;
    const complete = (value) => (isComplex ? completed(value ?? {}, definitions, part) : value);
    if (!isArray) return [name, complete(message[name])];
    const values = message[name] ?? Array(arrayLength).fill(0);
    return [name, isComplex ? values.map(complete) : values];
  });
  return { ...message, ...Object.fromEntries(parts) };
}

/// The message in the encoding of ROS 1.
export function encodeRos1(type, message) {
  const definitions = rosmsg.parse(ros1SchemaOf(type));
  const whole = completed(withRos1Names(message), definitions, undefined);
  return writerOf(ros1Type(type), () => new Ros1Writer(definitions)).writeMessage(whole);
}

export function header(time, frame) {
  const second = 1_000_000_000n;
  return { stamp: { sec: Number(time / second), nanosec: Number(time % second) }, frame_id: frame };
}

/// A PointCloud2 as drivers lay it out: a uint16 amid the floats, time not aligned.
export function pointCloud(time, frame, scan) {
  const kFloat = 7, kShort = 4, hasTime = scan.names.includes('time');
  const layout = [['x', 0, kFloat], ['y', 4, kFloat], ['z', 8, kFloat], ['intensity', 12, kFloat],
    ['azimuth', 16, kShort], ...(hasTime ? [['time', 18, kFloat]] : [])];
  const fields = layout.map(([name, offset, datatype]) => ({ name, offset, datatype, count: 1 }));
  const step = hasTime ? 22 : 18, from = 4 * scan.names.length, timeAt = 4 * scan.names.indexOf('time');
  const data = Buffer.alloc(step * scan.count);
  for (let i = 0; i < scan.count; ++i) {
    scan.data.copy(data, i * step, i * from, i * from + 16);
    data.writeUInt16LE(i % 64, i * step + 16);
    if (hasTime) scan.data.copy(data, i * step + 18, i * from + timeAt, i * from + timeAt + 4);
  }
  return { header: header(time, frame), height: 1, width: scan.count, fields, is_bigendian: false,
    point_step: step, row_step: data.length, data, is_dense: true };
}

/// The points of a scan with times, as the driver of a Livox sends them.
export function livoxMessage(time, frame, scan) {
  const columns = ['x', 'y', 'z', 'intensity', 'time'].map((name) => scan.names.indexOf(name));
  const points = Array.from({ length: scan.count }, (_, i) => {
    const [x, y, z, intensity, seconds] =
      columns.map((column) => scan.data.readFloatLE(4 * (i * scan.names.length + column)));
    return { offset_time: Math.round(1e9 * seconds), x, y, z, reflectivity: Math.round(255 * intensity), tag: 0x10,
      line: i % 6 };
  });
  return { header: header(time, frame), timebase: time, point_num: scan.count, lidar_id: 1, rsvd: [0, 0, 0], points };
}

/// A PNG file as an Image: rgb8 or bgr8, grey files as mono8. Rows end in bytes that are no pixels.
export function rawImage(time, frame, file, encoding) {
  const { width, height, data: rgba, color } = PNG.sync.read(file);
  const channels = color ? { rgb8: [0, 1, 2], bgr8: [2, 1, 0] }[encoding] : [0];
  const step = width * channels.length + 13;
  const data = Buffer.alloc(step * height, 0xa5);
  for (let row = 0; row < height; ++row) {
    for (let x = 0; x < width; ++x) {
      channels.forEach((channel, c) => {
        data[row * step + x * channels.length + c] = rgba[4 * (row * width + x) + channel];
      });
    }
  }
  return { header: header(time, frame), height, width, encoding: color ? encoding : 'mono8', is_bigendian: 0,
    step, data };
}

/// Of a camera of drive.toml. A pinhole is what ROS calls one: "plumb_bob" with zeros.
export function cameraInfo(time, frame, { width, height, K, D, distortion_model: model }) {
  const pinhole = model === 'none';
  const p = [0, 1, 2].flatMap((row) => [...K.slice(3 * row, 3 * row + 3), 0]);
  return { header: header(time, frame), height, width, distortion_model: pinhole ? 'plumb_bob' : model,
    d: pinhole ? [0, 0, 0, 0, 0] : D, k: K, r: [1, 0, 0, 0, 1, 0, 0, 0, 1], p };
}

const xyz = ([x, y, z]) => ({ x, y, z });
const xyzw = ([x, y, z, w]) => ({ x, y, z, w });

/// @param motion  `T_parent_child` as drive.toml has it: {translation, rotation}
export function transform(time, parent, child, { translation, rotation }) {
  return { header: header(time, parent), child_frame_id: child,
    transform: { translation: xyz(translation), rotation: xyzw(rotation) } };
}

export function odometry(time, frame, child, { translation, rotation }) {
  return { header: header(time, frame), child_frame_id: child,
    pose: { pose: { position: xyz(translation), orientation: xyzw(rotation) } } };
}

/// @param accuracy  m, of a coordinate; infinite: there is no fix, 0: not known
export function fix(time, frame, latitude, longitude, altitude, accuracy) {
  const kDiagonal = 2, kNoFix = -1, known = accuracy > 0 && accuracy < Infinity;
  const variance = known ? accuracy * accuracy : 0;
  return { header: header(time, frame), status: { status: accuracy === Infinity ? kNoFix : 0, service: 1 },
    latitude, longitude, altitude, position_covariance: [variance, 0, 0, 0, variance, 0, 0, 0, variance],
    position_covariance_type: known ? kDiagonal : 0 };
}

export function imu(time, frame, rotation, angularVelocity, acceleration) {
  return { header: header(time, frame), orientation: xyzw(rotation), angular_velocity: xyz(angularVelocity),
    linear_acceleration: xyz(acceleration) };
}
