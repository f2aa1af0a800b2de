// Smooth motion through stamped poses.
#pragma once

#include <optional>
#include <vector>

#include "fovea/trajectory.h"

namespace fovea {

/// A cubic Hermite curve on SE(3) through poses. The velocity at a pose is that between its
/// neighbors, so the motion has no kinks at the poses.
class PoseSpline {
 public:
  /// Poses more than this apart belong to different curves.
  static constexpr TimeNs kMaxGap = kNsPerSecond / 2;
  /// Longest time beyond the first and the last pose of a curve.
  static constexpr TimeNs kMaxExtrapolation = kNsPerSecond / 5;

  /// @param poses  in strictly increasing time
  explicit PoseSpline(std::vector<StampedPose> poses);

  struct State {
    RigidMotion T_local_body = RigidMotion::Identity();
    Twist velocity = Twist::Zero();  ///< per second, in the body frame
  };
  /// Pose and velocity at a time. Empty further out than the limits above, and for a curve of one
  /// pose.
  std::optional<State> at(TimeNs time) const;

 private:
  std::vector<StampedPose> poses_;  // with velocities
};

}  // namespace fovea
