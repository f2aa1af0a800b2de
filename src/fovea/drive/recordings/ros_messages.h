// The messages that a drive is made of, as the interfaces of ROS 2 and ROS 1 define them
// (sensor_msgs, nav_msgs, tf2_msgs). Both have the same fields in the same order; ROS 1 has a
// sequence number in the header. Unused fields are left out. Texts and data of the structures point
// into the message that they were read from. Every function throws InputError as MessageReader.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/drive/recordings/message_reader.h"
#include "fovea/geometry/quaternion_motion.h"
#include "fovea/time.h"

namespace fovea::ros {

inline constexpr std::string_view kPointCloud = "sensor_msgs/msg/PointCloud2";
inline constexpr std::string_view kImage = "sensor_msgs/msg/Image";
inline constexpr std::string_view kCompressedImage = "sensor_msgs/msg/CompressedImage";
inline constexpr std::string_view kCameraInfo = "sensor_msgs/msg/CameraInfo";
inline constexpr std::string_view kNavSatFix = "sensor_msgs/msg/NavSatFix";
inline constexpr std::string_view kImu = "sensor_msgs/msg/Imu";
inline constexpr std::string_view kOdometry = "nav_msgs/msg/Odometry";
inline constexpr std::string_view kTransforms = "tf2_msgs/msg/TFMessage";

/// std_msgs/msg/Header
struct Header {
  TimeNs stamp = 0;
  std::string frame;  ///< without the slash that ROS 1 put before it
};
Header read_header(MessageReader& message);
TimeNs read_time(MessageReader& message);

struct PointField {
  std::string_view name;
  std::uint32_t offset = 0;   ///< bytes from a point's first
  std::uint8_t datatype = 0;  ///< 1 to 8: INT8, UINT8, INT16, ... FLOAT32, FLOAT64
  std::uint32_t count = 0;
};
struct PointCloud2 {
  Header header;
  std::uint32_t height = 0, width = 0;
  std::vector<PointField> fields;
  bool big_endian = false;
  std::uint32_t point_step = 0, row_step = 0;  ///< bytes
  std::string_view data;
};
PointCloud2 read_point_cloud(MessageReader& message);

struct ImageMessage {
  Header header;
  std::uint32_t height = 0, width = 0;
  std::string_view encoding;
  bool big_endian = false;
  std::uint32_t step = 0;  ///< bytes of a row
  std::string_view data;
};
ImageMessage read_image(MessageReader& message);

struct CompressedImage {
  Header header;
  std::string_view format;
  std::string_view data;
};
CompressedImage read_compressed_image(MessageReader& message);

struct CameraInfo {
  Header header;
  std::uint32_t height = 0, width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{}, r{};  ///< by rows
  std::array<double, 12> p{};      ///< by rows
  std::uint32_t binning_x = 0, binning_y = 0;
  std::uint32_t roi_x = 0, roi_y = 0, roi_height = 0, roi_width = 0;
};
CameraInfo read_camera_info(MessageReader& message);

struct NavSatFix {
  Header header;
  bool fix = false;
  double latitude = 0, longitude = 0, altitude = 0;  ///< degrees, m above the WGS 84 ellipsoid
  std::array<double, 9> covariance{};                ///< m^2, east-north-up
  bool covariance_known = false;
};
NavSatFix read_nav_sat_fix(MessageReader& message);

struct Imu {
  Header header;
  std::optional<Eigen::Quaterniond> orientation;  ///< to east-north-up (REP 103); empty: not known
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();      ///< m/s^2
};
Imu read_imu(MessageReader& message);

struct Odometry {
  Header header;
  std::string child_frame;
  QuaternionMotion T_header_child;
};
/// InputError, too, for a pose that is none.
Odometry read_odometry(MessageReader& message);

struct Transform {
  Header header;
  std::string child_frame;
  QuaternionMotion T_header_child;
};
/// InputError, too, for a motion that is none.
std::vector<Transform> read_transforms(MessageReader& message);

}  // namespace fovea::ros
