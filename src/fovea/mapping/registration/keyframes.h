// Which scans later ones are registered against (docs/method.md 2.5).
#pragma once

#include <optional>

#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Chooses keyframes among scans that follow each other: the first, and each whose sensor is far
/// enough from the one chosen before. What lies between tells the target little, and a vehicle that
/// stands keeps what it saw on its way.
class Keyframes {
 public:
  /// @param distance  m, and
  /// @param rotation  rad, of which one suffices; 0: all scans are keyframes
  Keyframes(double distance, double rotation) : distance_(distance), rotation_(rotation) {}

  /// Whether the next scan is one.
  bool takes(const RigidMotion& T_odom_lidar) {
    if (last_ && !is_far(last_->inverse() * T_odom_lidar)) return false;
    last_ = T_odom_lidar;
    return true;
  }

 private:
  bool is_far(const RigidMotion& moved) const {
    return moved.translation().norm() >= distance_ || rotation_angle(moved.linear()) >= rotation_;
  }

  double distance_, rotation_;
  std::optional<RigidMotion> last_;
};

}  // namespace fovea
