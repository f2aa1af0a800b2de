// A generic drive folder as a vehicle with ROS 2 or ROS 1 would have recorded it. mcap_bag.mjs, rosbag2_folder.mjs and
// ros1_bag.mjs write that to files.
import { readFileSync } from 'node:fs';

import { numberOf, readScan } from './drive_folder.mjs';
import * as ros from './ros_messages.mjs';

const identity = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };

const lidarFrame = 'velodyne';
const opticalFrame = (camera) => `${camera.name}_optical_frame`;
const numbersOf = (row, names) => names.map((name) => numberOf(row[name]));

/// The messages, by the time at which they were recorded: some milliseconds after their stamps.
class Recording {
  messages = [];

  constructor(ros1) {
    this.encode = ros1 ? ros.encodeRos1 : ros.encode;
    this.typeOf = ros1 ? ros.ros1Type : (type) => type;
  }

  /// @param delay  ms from the stamp until the message has come
  add(topic, type, time, delay, message) {
    const jitter = BigInt((this.messages.length * 7919) % 1000) * 1000n;
    const recorded = time + BigInt(delay) * 1_000_000n + jitter;
    this.messages.push({ topic, type: this.typeOf(type), time: recorded, data: this.encode(type, message) });
  }

  inOrder() {
    return this.messages.sort((a, b) => (a.time < b.time ? -1 : Number(a.time > b.time)));
  }
}

/// The scans of each LiDAR under all of `lidars`; of a drive with several, under the name of the LiDAR.
function addScans(recording, drive, lidars, livox) {
  const [type, encoded] = livox ? [ros.livoxType, ros.livoxMessage]
    : ['sensor_msgs/msg/PointCloud2', ros.pointCloud];
  for (const { name, T_lidar_sensor: isFurther, scans } of drive.lidars) {
    const topics = name ? [`/${name}/points`] : lidars;
    for (const { time, path } of scans) {
      const message = encoded(time, isFurther ? name : lidarFrame, readScan(path));
      for (const topic of topics) recording.add(topic, type, time, 60, message);
    }
  }
}

function addImages(recording, camera, encoding, withInfo) {
  const frame = opticalFrame(camera), topic = `/${camera.name}/image_raw`;
  const infoTopic = `/${camera.name}/camera_info`;
  for (const { time, path } of camera.images) {
    const file = readFileSync(path);
    if (encoding === 'compressed') {
      const message = { header: ros.header(time, frame), format: 'rgb8; png compressed bgr8', data: file };
      recording.add(`${topic}/compressed`, 'sensor_msgs/msg/CompressedImage', time, 25, message);
    } else {
      recording.add(topic, 'sensor_msgs/msg/Image', time, 25, ros.rawImage(time, frame, file, encoding));
    }
    if (withInfo) {
      recording.add(infoTopic, 'sensor_msgs/msg/CameraInfo', time, 24, ros.cameraInfo(time, frame, camera));
    }
  }
}

/// They are recorded late, when the first scans and images are there already.
function addStaticTransforms(recording, drive, withCameras) {
  const { T_body_lidar, T_body_imu, antenna } = drive.body, { time } = drive.scans[0];
  const type = 'tf2_msgs/msg/TFMessage';
  const add = (...transforms) => recording.add('/tf_static', type, time, 110, { transforms });
  add(ros.transform(time, 'base_link', lidarFrame, T_body_lidar ?? identity),
    ros.transform(time, 'base_link', 'imu', T_body_imu ?? identity),
    ros.transform(time, 'base_link', 'gnss', { ...identity, translation: antenna ?? [0, 0, 0] }));
  const further = drive.lidars.slice(1);
  if (further.length > 0) {
    add(...further.map(({ name, T_lidar_sensor: T }) => ros.transform(time, lidarFrame, name, T)));
  }
  if (!withCameras) return;
  add(...drive.cameras.map((camera) =>
    ros.transform(time, lidarFrame, opticalFrame(camera), camera.T_lidar_cam)));
}

function addPoses(recording, drive, as) {
  for (const row of drive.poses) {
    const T_world_body = {
      translation: numbersOf(row, ['x', 'y', 'z']), rotation: numbersOf(row, ['qx', 'qy', 'qz', 'qw']) };
    if (as === 'odometry') {
      const message = ros.odometry(row.time, 'map', 'base_link', T_world_body);
      recording.add('/odom', 'nav_msgs/msg/Odometry', row.time, 3, message);
    } else {
      const transforms = [ros.transform(row.time, 'map', 'base_link', T_world_body)];
      recording.add('/tf', 'tf2_msgs/msg/TFMessage', row.time, 3, { transforms });
    }
  }
}

const inertiaColumns = [['qx', 'qy', 'qz', 'qw'], ['wx', 'wy', 'wz'], ['ax', 'ay', 'az']];

function addNavigation(recording, drive) {
  for (const row of drive.positions) {
    const values = numbersOf(row, ['latitude', 'longitude', 'altitude', 'accuracy']);
    recording.add('/gnss/fix', 'sensor_msgs/msg/NavSatFix', row.time, 45, ros.fix(row.time, 'gnss', ...values));
  }
  for (const row of drive.inertia) {
    const values = inertiaColumns.map((names) => numbersOf(row, names));
    recording.add('/imu/data', 'sensor_msgs/msg/Imu', row.time, 1, ros.imu(row.time, 'imu', ...values));
  }
}

/// Messages of a drive of readDrive(): {topic, type, time, data}, in the order of their times.
/// @param poses  "odometry", "tf" or "gnss"
/// @param images  "compressed", "rgb8" or "bgr8"
/// @param livox  scans as a Livox's driver sends them
/// @param ros1  messages of ROS 1 instead of ROS 2
export function record(drive, { poses = 'odometry', images = 'compressed', lidars = ['/lidar/points'],
  cameraInfos = true, cameraTransforms = true, livox = false, ros1 = false } = {}) {
  const recording = new Recording(ros1);
  addScans(recording, drive, lidars, livox);
  for (const camera of drive.cameras) addImages(recording, camera, images, cameraInfos);
  addStaticTransforms(recording, drive, cameraTransforms);
  if (poses === 'gnss') addNavigation(recording, drive);
  else addPoses(recording, drive, poses);
  return recording.inOrder();
}

/// The topics of messages: {name, type, qos}, as rosbag2 tells of them.
export function topicsOf(messages) {
  const types = new Map(messages.map(({ topic, type }) => [topic, type]));
  const forever = '\n    sec: 9223372036\n    nsec: 854775807\n';
  return [...types].map(([name, type]) => ({ name, type,
    qos: '- history: 3\n  depth: 0\n  reliability: 1\n'
      + `  durability: ${name === '/tf_static' ? 1 : 2}\n  deadline:${forever}  lifespan:${forever}`
      + `  liveliness: 1\n  liveliness_lease_duration:${forever}  avoid_ros_namespace_conventions: false` }));
}
