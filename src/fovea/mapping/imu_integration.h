// From the measurements of an IMU to its motion.
#pragma once

#include "fovea/geometry/imu_data.h"

namespace fovea {

/// Motion of an IMU at a moment, and its errors.
struct InertialState {
  TimeNs time = 0;
  RigidMotion T_odom_imu = RigidMotion::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< in odom, m/s
  Eigen::Vector3d rate_bias = Eigen::Vector3d::Zero();   ///< rad/s
  Eigen::Vector3d force_bias = Eigen::Vector3d::Zero();  ///< m/s^2
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();     ///< in odom, m/s^2, points down

  /// Errors: rotation (IMU axes, rad), position and velocity (odom axes), both biases, and the
  /// angles of gravity about two axes across it. The values are their places in the covariance.
  enum Error {
    kRotation = 0,
    kPosition = 3,
    kVelocity = 6,
    kRateBias = 9,
    kForceBias = 12,
    kGravityAngles = 15,
    kSize = 17
  };
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  Covariance covariance = Covariance::Zero();
};

/// Unit vectors of the two axes of gravity's error. They change with gravity as little as it does:
/// the covariance refers to them.
Eigen::Matrix<double, 3, 2> across_gravity(const InertialState& state);

/// Strapdown integration by the midpoint rule.
class ImuIntegration {
 public:
  /// @param imu  must outlive the integration
  explicit ImuIntegration(const ImuData& imu);

  /// Whether the IMU measured at most half a second before a time.
  bool covers(TimeNs stamp) const;

  /// Moves a state to another time, earlier or later. In gaps of the IMU the velocities stay as
  /// they are, with large deviations.
  /// @param with_covariance  or else the state's stays; only to a later time
  void move(InertialState& state, TimeNs time, bool with_covariance) const;

  /// Angular velocity at a state, rad/s.
  Eigen::Vector3d rate(const InertialState& state) const {
    return measured(state.time, state.time).rate - state.rate_bias;
  }

 private:
  struct Measured {
    Eigen::Vector3d rate, force;
    bool is_gap = false;
  };

  /// Mean of the measurements between two times that no sample separates; in a gap those before.
  Measured measured(TimeNs from, TimeNs to) const;
  void step(InertialState& state, TimeNs time, bool with_covariance) const;

  const ImuData* imu_;
  TimeNs gap_limit_ = 0;
};

}  // namespace fovea
