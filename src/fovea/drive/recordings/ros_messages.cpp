#include "fovea/drive/recordings/ros_messages.h"

#include <cmath>

#include "fovea/errors.h"

namespace fovea::ros {
namespace {

std::string frame_name(std::string_view text) {
  if (text.starts_with('/')) text.remove_prefix(1);
  return std::string(text);
}

Eigen::Vector3d read_vector(MessageReader& message) {
  const auto v = message.doubles<3>();
  return {v[0], v[1], v[2]};
}

Eigen::Quaterniond read_quaternion(MessageReader& message) {
  const auto q = message.doubles<4>();
  return {q[3], q[0], q[1], q[2]};
}

bool is_rotation_of_length_1(const Eigen::Quaterniond& q) {
  return std::abs(q.norm() - 1) < 0.01;  // NaN is not
}

QuaternionMotion read_motion(MessageReader& message) {
  QuaternionMotion T;
  T.translation = read_vector(message);
  T.rotation = read_quaternion(message);
  if (!T.translation.allFinite() || !is_rotation_of_length_1(T.rotation)) {
    throw InputError("a motion has no finite place, or a quaternion that is not of length 1",
                     message.where(), "mend the node that publishes it");
  }
  constexpr double kRounding = 1e-9;  // numbers that are right stay as they are
  if (std::abs(T.rotation.norm() - 1) > kRounding) T.rotation.normalize();
  return T;
}

}  // namespace

TimeNs read_time(MessageReader& message) {
  const auto sec = message.number<std::int32_t>();
  const auto nanosec = message.number<std::uint32_t>();
  return TimeNs{sec} * kNsPerSecond + TimeNs{nanosec};
}

Header read_header(MessageReader& message) {
  Header header;
  if (message.is_ros1()) message.number<std::uint32_t>();  // sequence number
  header.stamp = read_time(message);
  header.frame = frame_name(message.text());
  return header;
}

PointCloud2 read_point_cloud(MessageReader& message) {
  PointCloud2 cloud;
  cloud.header = read_header(message);
  cloud.height = message.number<std::uint32_t>();
  cloud.width = message.number<std::uint32_t>();
  constexpr std::size_t kLeastBytes = 4 + 4 + 1 + 4;  // of a field
  for (std::size_t left = message.count(kLeastBytes); left > 0; --left) {
    PointField& field = cloud.fields.emplace_back();
    field.name = message.text();
    field.offset = message.number<std::uint32_t>();
    field.datatype = message.number<std::uint8_t>();
    field.count = message.number<std::uint32_t>();
  }
  cloud.big_endian = message.boolean();
  cloud.point_step = message.number<std::uint32_t>();
  cloud.row_step = message.number<std::uint32_t>();
  cloud.data = message.bytes();
  return cloud;
}

ImageMessage read_image(MessageReader& message) {
  ImageMessage image;
  image.header = read_header(message);
  image.height = message.number<std::uint32_t>();
  image.width = message.number<std::uint32_t>();
  image.encoding = message.text();
  image.big_endian = message.boolean();
  image.step = message.number<std::uint32_t>();
  image.data = message.bytes();
  return image;
}

CompressedImage read_compressed_image(MessageReader& message) {
  CompressedImage image;
  image.header = read_header(message);
  image.format = message.text();
  image.data = message.bytes();
  return image;
}

CameraInfo read_camera_info(MessageReader& message) {
  CameraInfo info;
  info.header = read_header(message);
  info.height = message.number<std::uint32_t>();
  info.width = message.number<std::uint32_t>();
  info.distortion_model = message.text();
  info.d.resize(message.count(sizeof(double)));
  for (double& coefficient : info.d) coefficient = message.number<double>();
  info.k = message.doubles<9>();
  info.r = message.doubles<9>();
  info.p = message.doubles<12>();
  info.binning_x = message.number<std::uint32_t>();
  info.binning_y = message.number<std::uint32_t>();
  info.roi_x = message.number<std::uint32_t>();
  info.roi_y = message.number<std::uint32_t>();
  info.roi_height = message.number<std::uint32_t>();
  info.roi_width = message.number<std::uint32_t>();
  return info;
}

NavSatFix read_nav_sat_fix(MessageReader& message) {
  NavSatFix fix;
  fix.header = read_header(message);
  fix.fix = message.number<std::int8_t>() >= 0;
  message.number<std::uint16_t>();  // which satellites
  fix.latitude = message.number<double>();
  fix.longitude = message.number<double>();
  fix.altitude = message.number<double>();
  fix.covariance = message.doubles<9>();
  fix.covariance_known = message.number<std::uint8_t>() != 0;
  return fix;
}

Imu read_imu(MessageReader& message) {
  Imu imu;
  imu.header = read_header(message);
  const Eigen::Quaterniond orientation = read_quaternion(message);
  const bool known = message.doubles<9>()[0] != -1;  // what the interface sets where there is none
  if (known && is_rotation_of_length_1(orientation)) imu.orientation = orientation;
  imu.angular_velocity = read_vector(message);
  message.doubles<9>();
  imu.acceleration = read_vector(message);
  return imu;
}

Odometry read_odometry(MessageReader& message) {
  Odometry odometry;
  odometry.header = read_header(message);
  odometry.child_frame = frame_name(message.text());
  odometry.T_header_child = read_motion(message);
  return odometry;
}

std::vector<Transform> read_transforms(MessageReader& message) {
  constexpr std::size_t kLeastBytes = 8 + 4 + 4 + 7 * 8;
  std::vector<Transform> transforms(message.count(kLeastBytes));
  for (Transform& transform : transforms) {
    transform.header = read_header(message);
    transform.child_frame = frame_name(message.text());
    transform.T_header_child = read_motion(message);
  }
  return transforms;
}

}  // namespace fovea::ros
