// Selection of the scans that later scans are registered against (docs/method.md 2.5).
#pragma once

#include <optional>

#include "fovea/rigid_motion.h"

namespace fovea {

struct KeyframeOptions {
  /// m and rad from the last keyframe; reaching one of them suffices. 0: each scan is a keyframe
  double distance = 0, rotation = 0;
  double overlap = 0;  ///< a scan with a smaller share of its points in the target is a keyframe
};

/// Selects keyframes in a sequence of scans: the first scan, each scan far enough from the last
/// keyframe, and each scan with a low overlap. A scan between keyframes adds little to the target.
/// A standing vehicle adds no keyframes, so the target keeps the surfaces along its way.
class Keyframes {
 public:
  explicit Keyframes(const KeyframeOptions& options) : options_(options) {}

  /// The next scan is a keyframe at any pose.
  void restart() { last_.reset(); }

  /// Whether the next scan is a keyframe. If so, it becomes the last keyframe.
  /// @param overlap  share of the scan's points that have a counterpart in the target
  bool add_if_due(const RigidMotion& T_odom_lidar, double overlap) {
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
