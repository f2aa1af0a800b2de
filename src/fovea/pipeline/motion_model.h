// Where the vehicle must be now: the first guess of a pose, before the scan is registered.
#pragma once

#include <optional>

#include "fovea/base/time.h"
#include "fovea/geometry/trajectory.h"

namespace fovea {

struct MotionPrediction {
  RigidMotion T_local_lidar = RigidMotion::Identity();
  /// Twist per second of the LiDAR in its own frame during the sweep; absent where nothing is
  /// known.
  std::optional<Twist> velocity;
  /// Pose by navigation alone.
  std::optional<RigidMotion> T_local_lidar_navigation;
};

/// Predicts by the navigation's motion since the last frame, or else by constant velocity.
class MotionModel {
 public:
  /// @param navigation   of the LiDAR, or null; must outlive the model
  /// @param interpolate  between records; false: the pose of the record nearest in time
  explicit MotionModel(const Trajectory* navigation, bool interpolate = true)
      : navigation_(navigation), interpolate_(interpolate) {}

  /// @param sweep_end  what is known later than this is not used for the velocity (live)
  MotionPrediction predict(TimeNs stamp, TimeNs sweep_end) const;

  /// Tells the pose that the frame got in the end.
  void update(TimeNs stamp, const RigidMotion& T_local_lidar);

 private:
  std::optional<RigidMotion> navigation_at(TimeNs stamp) const;

  const Trajectory* navigation_;
  bool interpolate_;
  std::optional<StampedPose> last_, before_last_;
};

}  // namespace fovea
