// What the readers of recordings have in common: topics, and who wants their messages.
#pragma once

#include <string>
#include <string_view>

namespace fovea {

/// The only encoding of messages that is read: what ROS 2 writes.
inline constexpr std::string_view kCdrEncoding = "cdr";

struct BagTopic {
  std::string name;      ///< "/lidar/points"
  std::string type;      ///< "sensor_msgs/msg/PointCloud2"; empty where the recording does not say
  std::string encoding;  ///< of its messages: "cdr", or what is not read
};

class BagSink {
 public:
  virtual ~BagSink() = default;

  /// Called for each topic of a file before its messages; whether these are wanted.
  virtual bool is_requested(const BagTopic& topic) = 0;
  /// Called for each message that is wanted, in the file's order.
  /// @param message  valid during the call
  virtual void add(const BagTopic& topic, std::string_view message) = 0;
  /// Called for each message of the other topics.
  virtual void skip(const BagTopic& /*topic*/) {}
};

}  // namespace fovea
