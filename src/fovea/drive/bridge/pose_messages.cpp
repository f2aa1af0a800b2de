#include "fovea/drive/bridge/pose_messages.h"

#include <array>
#include <nlohmann/json.hpp>

#include "fovea/drive/bridge/message_writer.h"
#include "fovea/drive/bridge/pose_schemas.h"
#include "fovea/geometry/quaternion_motion.h"

namespace fovea::bridge {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Fields that are zero: no velocity is published, and a covariance of zeros is unknown.
constexpr std::array<double, 6> kNoTwist{};
constexpr std::array<double, 36> kUnknownCovariance{};

std::array<double, 36> covariance_of(const PublishedPose& pose) {
  std::array<double, 36> rows = kUnknownCovariance;
  if (const std::optional<PoseCovariance> covariance = covariance_in_world(pose)) {
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows.data()) = *covariance;
  }
  return rows;
}

/// x, y, z, then the quaternion x, y, z, w.
std::array<double, 7> numbers_of(const RigidMotion& T) {
  const QuaternionMotion motion(T);
  const Eigen::Vector3d& t = motion.translation;
  const Eigen::Quaterniond q = motion.rotation.normalized();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

struct Stamp {
  TimeNs second, nanosecond;
};
Stamp stamp_of(TimeNs time) {
  const TimeNs nanosecond = (time % kNsPerSecond + kNsPerSecond) % kNsPerSecond;
  return {(time - nanosecond) / kNsPerSecond, nanosecond};
}

void write_header(const PublishedPose& pose, MessageWriter& message) {
  const auto [second, nanosecond] = stamp_of(pose.stamp);
  if (message.is_ros1()) message.number(static_cast<std::uint32_t>(pose.frame));
  message.number(static_cast<std::int32_t>(second));
  message.number(static_cast<std::uint32_t>(nanosecond));
  message.text(kWorldFrame);
}

std::string odometry(const PublishedPose& pose, std::string_view encoding) {
  MessageWriter message(encoding);
  write_header(pose, message);
  message.text(kLidarFrame);
  message.doubles(numbers_of(pose.T_world_lidar));
  message.doubles(covariance_of(pose));
  message.doubles(kNoTwist);
  message.doubles(kUnknownCovariance);
  return message.bytes();
}

std::string transforms(const PublishedPose& pose, std::string_view encoding) {
  MessageWriter message(encoding);
  message.number(std::uint32_t{1});  // transform
  write_header(pose, message);
  message.text(kLidarFrame);
  message.doubles(numbers_of(pose.T_world_lidar));
  return message.bytes();
}

std::string text_of(const OrderedJson& json) {
  return json.dump(-1, ' ', /*ensure_ascii=*/false, OrderedJson::error_handler_t::replace);
}

std::string state_text(const PublishedPose& pose) {
  return text_of({{"frame", pose.frame}, {"stamp_ns", pose.stamp}, {"state", pose.state}});
}

std::string state(const PublishedPose& pose, std::string_view encoding) {
  MessageWriter message(encoding);
  message.text(state_text(pose));
  return message.bytes();
}

OrderedJson header_json(const PublishedPose& pose) {
  const auto [second, nanosecond] = stamp_of(pose.stamp);
  return {{"stamp", {{"sec", second}, {"nanosec", nanosecond}}}, {"frame_id", kWorldFrame}};
}

OrderedJson vector_json(double x, double y, double z) { return {{"x", x}, {"y", y}, {"z", z}}; }

OrderedJson quaternion_json(const std::array<double, 7>& numbers) {
  return {{"x", numbers[3]}, {"y", numbers[4]}, {"z", numbers[5]}, {"w", numbers[6]}};
}

OrderedJson odometry_json(const PublishedPose& pose) {
  const std::array<double, 7> numbers = numbers_of(pose.T_world_lidar);
  const OrderedJson none = vector_json(0, 0, 0);
  const OrderedJson at = {{"position", vector_json(numbers[0], numbers[1], numbers[2])},
                          {"orientation", quaternion_json(numbers)}};
  return {{"header", header_json(pose)},
          {"child_frame_id", kLidarFrame},
          {"pose", {{"pose", at}, {"covariance", covariance_of(pose)}}},
          {"twist",
           {{"twist", {{"linear", none}, {"angular", none}}}, {"covariance", kUnknownCovariance}}}};
}

OrderedJson transforms_json(const PublishedPose& pose) {
  const std::array<double, 7> numbers = numbers_of(pose.T_world_lidar);
  const OrderedJson transform = {{"translation", vector_json(numbers[0], numbers[1], numbers[2])},
                                 {"rotation", quaternion_json(numbers)}};
  OrderedJson list = OrderedJson::array();
  list.push_back(
      {{"header", header_json(pose)}, {"child_frame_id", kLidarFrame}, {"transform", transform}});
  return {{"transforms", list}};
}

}  // namespace

std::vector<ClientChannel> pose_channels(std::string_view encoding) {
  const bool is_ros1 = encoding == kRos1Encoding;
  const std::string schema_encoding = is_ros1 ? "ros1msg" : "ros2msg";
  const auto channel = [&](std::uint32_t id, std::string_view topic, const char* package,
                           const char* type, std::string schema) {
    const std::string name = std::string(package) + (is_ros1 ? "/" : "/msg/") + type;
    return ClientChannel{id,   std::string(topic), std::string(encoding),
                         name, std::move(schema),  schema_encoding};
  };
  return {channel(1, kOdometryTopic, "nav_msgs", "Odometry", odometry_schema(is_ros1)),
          channel(2, kTransformTopic, "tf2_msgs", "TFMessage", transforms_schema(is_ros1)),
          channel(3, kStateTopic, "std_msgs", "String", string_schema())};
}

std::vector<std::string> pose_messages(const PublishedPose& pose, std::string_view encoding) {
  if (encoding == kJsonEncoding) {
    return {text_of(odometry_json(pose)), text_of(transforms_json(pose)),
            text_of({{"data", state_text(pose)}})};
  }
  return {odometry(pose, encoding), transforms(pose, encoding), state(pose, encoding)};
}

}  // namespace fovea::bridge
