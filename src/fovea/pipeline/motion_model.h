// Where the vehicle must be now: the first guesses of a pose, before the scan is registered.
#pragma once

#include <optional>
#include <vector>

#include "fovea/base/time.h"
#include "fovea/geometry/trajectory.h"

namespace fovea {

struct MotionGuess {
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  /// Twist per second of the LiDAR in its own frame during the sweep; absent where nothing is
  /// known.
  std::optional<Twist> velocity;
  bool by_navigation = false;
};

struct MotionPrediction {
  /// One, or two where navigation and the motion so far contradict each other: one of them is
  /// wrong, and the scan knows which. The more trusted one first.
  std::vector<MotionGuess> guesses;
  /// Pose by navigation alone.
  std::optional<RigidMotion> T_local_lidar_navigation;
};

struct MotionModelOptions {
  bool interpolate = true;  ///< navigation between records; false: the record nearest in time
  bool doubt = true;        ///< a second guess where navigation contradicts the motion so far
};

/// Predicts by the navigation's motion since the last frame, or else by constant velocity.
class MotionModel {
 public:
  /// @param navigation  T_local_lidar, or null; must outlive the model
  explicit MotionModel(const Trajectory* navigation, const MotionModelOptions& options = {})
      : navigation_(navigation), options_(options) {}

  /// @param sweep_end  what is known later than this is not used for the velocity (live)
  MotionPrediction predict(TimeNs stamp, TimeNs sweep_end) const;

  /// Tells the pose that the frame got in the end.
  void update(TimeNs stamp, const RigidMotion& T_odom_lidar);

 private:
  std::optional<RigidMotion> navigation_at(TimeNs stamp) const;
  std::optional<MotionGuess> by_navigation(TimeNs stamp, TimeNs sweep_end) const;
  std::optional<MotionGuess> by_velocity(TimeNs stamp) const;

  const Trajectory* navigation_;
  MotionModelOptions options_;
  std::optional<StampedPose> last_, before_last_;
};

}  // namespace fovea
