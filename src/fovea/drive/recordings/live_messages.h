// Messages of a running robot as data of a LiveSource.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "fovea/drive/live/live_source.h"
#include "fovea/drive/recordings/conversion_plan.h"
#include "fovea/drive/recordings/scan_message.h"
#include "fovea/drive/recordings/transform_course.h"

namespace fovea {

/// Passes the messages of a plan to a LiveSource. The numbers are those that RecordingWriter
/// writes.
class LiveMessages : public BagSink {
 public:
  /// @param index     of the messages that the plan was made from
  /// @param duration  s from the first scan: later messages are not passed on
  /// @param source    outlives this
  LiveMessages(const BagIndex& index, const ConversionPlan& plan, double duration,
               LiveSource& source);

  /// Requests the topics of the plan.
  bool is_requested(const BagTopic& topic) override;
  /// A message that cannot be used is counted.
  void add(const BagTopic& topic, std::string_view bytes) override;

  /// Whether all scans and images of the duration have come.
  bool is_over() const { return is_over_; }
  const std::map<std::string, UnusableMessages>& unusable() const { return unusable_; }

 private:
  struct Sensor {
    std::string name;   ///< of a LiDAR or camera
    std::string frame;  ///< of its messages
    ScanFormat format;  ///< of a LiDAR
    bool is_first_lidar = false;
  };
  using Use = void (LiveMessages::*)(const BagTopic&, MessageReader&);

  /// Nullptr if no message of this topic is used.
  Use use_of(const BagTopic& topic) const;
  void add_scan(const BagTopic& topic, MessageReader& message);
  void add_image(const BagTopic& topic, MessageReader& message);
  void add_compressed(const BagTopic& topic, MessageReader& message);
  void add_fix(const BagTopic& topic, MessageReader& message);
  void add_imu(const BagTopic& topic, MessageReader& message);
  void add_odometry(const BagTopic& topic, MessageReader& message);
  void add_transforms(const BagTopic& topic, MessageReader& message);

  LiveSource& source_;
  std::map<std::string, Sensor> lidars_, cameras_;  // by topic
  NavigationPlan navigation_;
  std::optional<TransformCourse> course_;
  TimeNs end_ = std::numeric_limits<TimeNs>::max() / 2;  // of the duration
  bool is_over_ = false;
  std::map<std::string, UnusableMessages> unusable_;  // by topic
};

}  // namespace fovea
