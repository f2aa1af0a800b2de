// Motion from an IMU and poses: an error-state Kalman filter (Sola 2017; its state as in FAST-LIO2,
// Xu et al. 2022).
#pragma once

#include <optional>

#include "fovea/mapping/imu_integration.h"
#include "fovea/sweep_motion.h"

namespace fovea {

/// What is known of the motion when the filter begins.
struct InertialStart {
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  std::optional<Twist> velocity;  ///< of the LiDAR in its own frame, a second
  bool is_level = false;          ///< the z axis of odom points up
};

struct InertialPrediction {
  InertialState state;
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  Twist sigma = Twist::Zero();  ///< standard deviations of a twist of the LiDAR: rad, m
};

/// The time of a sweep about its stamp, s.
struct SweepSpan {
  double begin = 0, end = 0;
};

class InertialFilter {
 public:
  /// @param imu  must outlive the filter
  explicit InertialFilter(const ImuData& imu);

  /// Whether the IMU measured shortly before a time.
  bool covers(TimeNs stamp) const { return integration_.covers(stamp); }

  bool has_begun() const { return state_.has_value(); }
  void restart() { state_.reset(); }

  /// Begins at a pose. Gravity is the mean acceleration of about a second. At rest, the mean rate
  /// is the bias of the gyroscope.
  void begin(TimeNs stamp, const InertialStart& start);

  /// The motion up to a later time as measured. In gaps of the IMU the velocities stay as they are,
  /// with large deviations. std::logic_error before begin().
  InertialPrediction predict(TimeNs stamp) const;
  /// Motion of the LiDAR during a sweep, with a path.
  SweepMotion motion(const InertialPrediction& prediction, const SweepSpan& sweep) const;

  /// Corrects a prediction by a pose of the LiDAR from another source.
  /// @param sigma  standard deviations of a twist of the LiDAR: rad, m
  InertialPrediction corrected(const InertialPrediction& prediction,
                               const RigidMotion& T_odom_lidar, const Twist& sigma) const;
  /// ... by the forward speed of a vehicle's body, m/s.
  InertialPrediction corrected(const InertialPrediction& prediction, double speed, double sigma,
                               const RigidMotion& T_lidar_body) const;

  /// Ends a frame whose pose registration has found.
  /// @param sigma  of the pose; absent: it is no measurement, and the prediction stays
  void update(const InertialPrediction& prediction, const RigidMotion& T_odom_lidar,
              const std::optional<Twist>& sigma);

  /// Ends a frame at a pose that no motion leads to, such as after a search: it keeps velocity,
  /// biases and gravity of the prediction. Restarts if these are no numbers.
  void place(const InertialPrediction& prediction, const RigidMotion& T_odom_lidar);

  const InertialState& state() const { return *state_; }

 private:
  using PoseJacobian = Eigen::Matrix<double, 6, InertialState::kSize>;
  PoseJacobian pose_jacobian(const InertialState& state) const;
  Twist pose_sigma(const InertialState& state) const;
  /// Of the LiDAR in its own frame.
  Twist velocity_of(const InertialState& state) const;
  RigidMotion T_odom_lidar(const InertialState& state) const {
    return state.T_odom_imu * T_imu_lidar_;
  }

  const ImuData* imu_;
  ImuIntegration integration_;
  RigidMotion T_imu_lidar_;
  std::optional<InertialState> state_;
};

}  // namespace fovea
