// Keys of drive.toml that describe an IMU and wheels.
#pragma once

#include <optional>

#include "fovea/core/settings.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/motion_keys.h"

namespace fovea {

/// The keys of [imu].
class ImuKeys {
 public:
  void visit(SettingVisitor& visit);
  /// Empty unless the table states where the IMU sits. ConfigError whose place is the key.
  std::optional<ImuDescription> imu() const;

 private:
  ImuDescription imu_;
  MotionKeys T_lidar_imu_{"imu", "lidar", "imu"};
};

}  // namespace fovea
