// What the readers of recordings have in common: topics, and the receiver of their messages.
#pragma once

#include <string>
#include <string_view>

namespace fovea {

/// The encodings of messages that are read: those of ROS 2 and of ROS 1.
inline constexpr std::string_view kCdrEncoding = "cdr", kRos1Encoding = "ros1";

struct BagTopic {
  std::string name;      ///< "/lidar/points"
  std::string type;      ///< "sensor_msgs/msg/PointCloud2"; empty where the recording has none
  std::string encoding;  ///< of its messages: "cdr", "ros1", or another one, which is not read

  bool is_readable() const { return encoding == kCdrEncoding || encoding == kRos1Encoding; }
};

/// A type of ROS 1 under its name in ROS 2: "sensor_msgs/msg/Imu" for "sensor_msgs/Imu".
std::string ros2_type(std::string_view ros1_type);

class BagSink {
 public:
  virtual ~BagSink() = default;

  /// Called for each topic of a file before its messages. Returns whether they are requested.
  virtual bool is_requested(const BagTopic& topic) = 0;
  /// Called for each requested message, in the file's order.
  /// @param message  valid during the call
  virtual void add(const BagTopic& topic, std::string_view message) = 0;
  /// Called for each message of the other topics.
  virtual void skip(const BagTopic& /*topic*/) {}
  /// Called if a file could be read in part only.
  /// @param problem  where it ends, and what is lost
  virtual void report_loss(const std::string& /*problem*/) {}
};

}  // namespace fovea
