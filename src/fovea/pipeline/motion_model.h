// Motion model: predicts the pose of a frame before its scan is registered.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fovea/pipeline/inertial_motion.h"
#include "fovea/pipeline/motion_history.h"
#include "fovea/time.h"
#include "fovea/trajectory.h"

namespace fovea {

struct MotionPrediction {
  /// One guess, or more if navigation, the IMU and the motion so far contradict each other;
  /// registration then decides. The more reliable one first.
  std::vector<MotionGuess> guesses;
  /// How many times better than the first one a further guess must fit.
  double least_gain = 1;
  /// Pose from navigation only.
  std::optional<RigidMotion> T_local_lidar_navigation;
  /// The frame follows a pause, so earlier velocities do not count. The guess is from navigation,
  /// or else the last pose.
  bool after_pause = false;
};

struct MotionModelOptions {
  /// Compares navigation with the motion so far: weights both for the velocity, and adds a second
  /// guess if they contradict each other.
  bool doubt = true;
  /// m, standard deviation of positions that navigation states; 0: none.
  double stated_accuracy = 0;
  /// From a frame's stamp to the end of its sweep. Later navigation does not count for the
  /// velocity, since it is not available live.
  TimeNs sweep_rest = 0;
  /// The z axis of navigation's poses points up.
  bool navigation_is_level = false;
};

/// What tells the motion besides the scans: null where the drive lacks it. All must outlive the
/// model.
struct MotionSources {
  const Trajectory* navigation = nullptr;  ///< T_local_lidar
  const ImuData* imu = nullptr;
  const WheelData* wheels = nullptr;  ///< used with an IMU
};

/// Error of predicted velocities.
class VelocityError {
 public:
  void add(const Twist& predicted, const Twist& actual);
  /// Mean square of each coordinate over about the last ten.
  const Twist& mean_square() const { return mean_square_; }

 private:
  Twist mean_square_ = before_any();
  int count_ = 1;  // the initial value

  static Twist before_any();
};

/// Predicts by the navigation's motion since the last frame, or else by constant velocity. The
/// velocity for motion compensation is the mean of those of navigation and of the last frames. The
/// weight of each coordinate depends on the errors of their latest predictions. A jitter of
/// positions by 1 cm is an error of 0.14 m/s in 0.1 s. The error of the last frames is the
/// acceleration.
///
/// With an IMU its InertialMotion predicts. Navigation and wheels correct its predictions.
class MotionModel {
 public:
  explicit MotionModel(const MotionSources& sources, const MotionModelOptions& options = {});
  explicit MotionModel(const MotionHistory& history, const MotionModelOptions& options = {})
      : MotionModel(MotionSources{history.navigation(), history.imu(), history.wheels()}, options) {
  }
  explicit MotionModel(const Trajectory* navigation, const MotionModelOptions& options = {})
      : MotionModel(MotionSources{.navigation = navigation}, options) {}

  /// Sets the velocity (of the LiDAR, in its own frame, per second) at the beginning or after a
  /// pause, without navigation. It counts until the second pose.
  void begin_with(const std::optional<Twist>& velocity) { initial_velocity_ = velocity; }

  /// @param sweep  of the frame
  MotionPrediction predict(TimeNs stamp, const SweepSpan& sweep = {}) const;

  /// Whether a frame follows a pause of the recording: over 1 s after the last frame, and over
  /// three of the drive's usual steps.
  bool follows_pause(TimeNs stamp) const;
  /// Begins with the velocity at a frame if nothing states the motion before it.
  void begin_if_needed(TimeNs stamp, int frame,
                       const std::function<std::optional<Twist>(int frame)>& initial_velocity) {
    if (needs_initial_velocity(stamp)) begin_with(initial_velocity(frame));
  }
  /// Whether nothing states the motion before a frame: the first one, or one after a pause.
  bool needs_initial_velocity(TimeNs stamp) const { return !last_ || follows_pause(stamp); }

  /// Adds the final pose of a frame. The state of the model depends only on these calls.
  void update(TimeNs stamp, const RigidMotion& T_odom_lidar,
              PoseEvidence evidence = PoseEvidence::kFirm);

  /// Why the IMU is no longer used; empty if it is, or there is none.
  std::string fault_of_imu() const;

 private:
  /// Where the filter of the IMU begins: at the last frame, or else at this one.
  InertialMotion::Beginning beginning(TimeNs stamp) const;
  std::optional<MotionGuess> by_imu(TimeNs stamp, const SweepSpan& sweep,
                                    const std::optional<MotionGuess>& by_nav) const;
  MotionPrediction predict_after_pause(TimeNs stamp) const;
  std::optional<RigidMotion> navigation_at(TimeNs stamp) const;
  std::optional<SweepMotion> navigation_motion(TimeNs stamp) const;
  std::optional<Twist> motion_velocity() const;
  std::optional<MotionGuess> by_navigation(TimeNs stamp) const;
  std::optional<MotionGuess> by_velocity(TimeNs stamp) const;
  /// Standard deviations of navigation's motion over a time (s).
  Twist navigation_sigma(double elapsed) const;
  SweepMotion weighed(const SweepMotion& by_navigation, const SweepMotion& by_motion) const;

  const Trajectory* navigation_;
  MotionModelOptions options_;
  std::optional<Twist> initial_velocity_;
  std::optional<StampedPose> last_, before_last_;
  std::optional<TimeNs> usual_step_;  // from frame to frame, without pauses
  // Predictions for last_.
  std::optional<SweepMotion> last_by_navigation_;
  std::optional<Twist> last_by_motion_;
  VelocityError navigation_error_, motion_error_;
  std::optional<InertialMotion> inertial_;
};

}  // namespace fovea
