// Which scans later ones are registered against (docs/method.md 2.5).
#pragma once

#include <optional>

#include "fovea/geometry/rigid_motion.h"

namespace fovea {

struct KeyframeOptions {
  /// m, and rad, from the keyframe before, of which one suffices; 0: all scans are keyframes
  double distance = 0, rotation = 0;
  double overlap = 0;  ///< a scan of which less than this share is in the target is one anywhere
};

/// Chooses keyframes among scans that follow each other: the first, and each whose sensor is far
/// enough from the one chosen before, or which sees what those before do not. What lies between
/// tells the target little, and a vehicle that stands keeps what it saw on its way.
class Keyframes {
 public:
  explicit Keyframes(const KeyframeOptions& options) : options_(options) {}

  /// The next scan is one, wherever it is.
  void restart() { last_.reset(); }

  /// Whether the next scan is one.
  /// @param overlap  the share of its points that have a counterpart in the target
  bool takes(const RigidMotion& T_odom_lidar, double overlap) {
    if (last_ && overlap >= options_.overlap && !is_far(last_->inverse() * T_odom_lidar)) {
      return false;
    }
    last_ = T_odom_lidar;
    return true;
  }

 private:
  bool is_far(const RigidMotion& moved) const {
    return moved.translation().norm() >= options_.distance ||
           rotation_angle(moved.linear()) >= options_.rotation;
  }

  KeyframeOptions options_;
  std::optional<RigidMotion> last_;
};

}  // namespace fovea
