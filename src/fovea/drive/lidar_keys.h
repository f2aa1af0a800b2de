// Keys of drive.toml that describe a LiDAR.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "fovea/core/settings.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/motion_keys.h"

namespace fovea {

enum class TimeUnit { kAuto, kSecond, kMillisecond, kMicrosecond, kNanosecond };
enum class LengthUnit { kAuto, kMeter, kCentimeter, kMillimeter };
enum class ReferenceKey { kAuto, kStamp, kAbsolute, kFirstPoint, kNone };

/// The keys of [lidar], or of [lidar.NAME] in a drive with several LiDARs.
class LidarKeys {
 public:
  /// @param name  empty: the drive has one LiDAR
  explicit LidarKeys(const std::string& name);

  void visit(SettingVisitor& visit);
  /// ConfigError whose place is the key.
  LidarDescription lidar();
  /// Whether the table has a pose.
  bool has_pose() const { return T_lidar_sensor_.motion().has_value(); }
  const std::string& pose_key() const { return T_lidar_sensor_.forward.key; }

 private:
  std::string key(std::string_view name) const;
  void finish_scan_format();
  void finish_sweep();

  std::string table_;
  LidarDescription lidar_;
  std::string folder_;
  std::optional<double> sweep_start_deg_;
  TimeUnit time_unit_ = TimeUnit::kAuto;
  LengthUnit length_unit_ = LengthUnit::kAuto;
  ReferenceKey time_reference_ = ReferenceKey::kAuto;
  MotionKeys T_lidar_sensor_;
};

}  // namespace fovea
