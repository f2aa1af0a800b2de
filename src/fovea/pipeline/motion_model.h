// Where the vehicle must be now: the first guesses of a pose, before the scan is registered.
#pragma once

#include <optional>
#include <vector>

#include "fovea/base/time.h"
#include "fovea/geometry/trajectory.h"

namespace fovea {

struct MotionGuess {
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  /// Of the LiDAR during the sweep; absent where nothing is known.
  std::optional<SweepMotion> motion;
  bool by_navigation = false;
  /// Standard deviations of the pose, given the last one (rad, m); absent where nothing states
  /// them.
  std::optional<Twist> sigma;
};

struct MotionPrediction {
  /// One, or two where navigation and the motion so far contradict each other: one of them is
  /// wrong, and the scan knows which. The more trusted one first.
  std::vector<MotionGuess> guesses;
  /// Pose by navigation alone.
  std::optional<RigidMotion> T_local_lidar_navigation;
  /// The frame follows a pause: no velocity from before it counts. The guess is by navigation, or
  /// else the last pose.
  bool after_pause = false;
};

struct MotionModelOptions {
  bool interpolate = true;  ///< navigation between records; false: the record nearest in time
  /// Navigation is held against the motion so far: both are weighed for the velocity, and a second
  /// guess is made where they contradict each other.
  bool doubt = true;
  /// m, standard deviation of a position as navigation states it; 0: it states none.
  double stated_accuracy = 0;
  /// From a frame's stamp to the end of its sweep; what navigation tells later is not used for the
  /// velocity, since a live program would not know it.
  TimeNs sweep_rest = 0;
};

/// How wrong the velocities were that something foretold.
class VelocityError {
 public:
  void add(const Twist& foretold, const Twist& actual);
  /// Mean square of each coordinate; of the last ten or so.
  const Twist& mean_square() const { return mean_square_; }

 private:
  Twist mean_square_ = before_any();
  int count_ = 1;  // that one

  static Twist before_any();
};

/// Predicts by the navigation's motion since the last frame, or else by constant velocity. The
/// velocity, which undoes the sweep, is the mean of navigation's and of the motion so far, each
/// coordinate weighed by how well they foretold it for the last frames: positions that jitter by a
/// centimetre err by 0.14 m/s in 0.1 s, the motion so far by what the vehicle accelerates.
class MotionModel {
 public:
  /// @param navigation  T_local_lidar, or null; must outlive the model
  explicit MotionModel(const Trajectory* navigation, const MotionModelOptions& options = {})
      : navigation_(navigation), options_(options) {}

  /// The velocity (of the LiDAR, in its own frame, per second) at the beginning or after a pause,
  /// where it is known and navigation does not measure it. Counts until a second pose is known.
  void begin_with(const std::optional<Twist>& velocity) { initial_velocity_ = velocity; }

  MotionPrediction predict(TimeNs stamp) const;

  /// Whether a frame follows a pause of the recording: over 1 s after the last frame, and over
  /// three of the drive's usual steps.
  bool follows_pause(TimeNs stamp) const;
  /// Whether the model has no velocity of its own, because it has one pose since the beginning or
  /// the last pause.
  bool begins() const { return last_ && !before_last_; }

  /// Tells the pose that the frame got in the end. All else that the model knows is of these calls.
  void update(TimeNs stamp, const RigidMotion& T_odom_lidar);

 private:
  MotionPrediction predict_after_pause(TimeNs stamp) const;
  std::optional<RigidMotion> navigation_at(TimeNs stamp) const;
  std::optional<SweepMotion> navigation_motion(TimeNs stamp) const;
  std::optional<Twist> motion_velocity() const;
  std::optional<MotionGuess> by_navigation(TimeNs stamp) const;
  std::optional<MotionGuess> by_velocity(TimeNs stamp) const;
  /// Of navigation's motion over a time (s).
  Twist navigation_sigma(double elapsed) const;
  SweepMotion weighed(const SweepMotion& by_navigation, const SweepMotion& by_motion) const;

  const Trajectory* navigation_;
  MotionModelOptions options_;
  std::optional<Twist> initial_velocity_;
  std::optional<StampedPose> last_, before_last_;
  std::optional<TimeNs> usual_step_;  // from frame to frame, without pauses
  // What was foretold for last_.
  std::optional<SweepMotion> last_by_navigation_;
  std::optional<Twist> last_by_motion_;
  VelocityError navigation_error_, motion_error_;
};

}  // namespace fovea
