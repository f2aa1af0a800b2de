// Calibration of an IMU against a LiDAR from their rotations ("hand-eye", Tsai, Lenz 1989).
#pragma once

#include <string>
#include <vector>

#include "fovea/mapping/calibration/hand_eye_search.h"

namespace fovea {

/// Largest standard deviation of an observable direction of the mount, rad.
inline constexpr double kMaxMountSigma = 0.3 * kDegree;

/// Correction of an IMU's mount and clock: exp(rotation) * R_lidar_imu and stamp + delay are right.
struct ImuHandEye {
  /// rad, in the axes of the LiDAR; zero along unobservable directions.
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
  /// Of the error of the corrected mount: a small rotation about the axes of the LiDAR, rad^2.
  /// Unobservable directions have up to 1 rad.
  Eigen::Matrix3d rotation_covariance = Eigen::Matrix3d::Identity();
  /// Orthonormal directions (columns, in the axes of the LiDAR) and their standard deviations
  /// (rad). The first `observable_directions` are observable: with the others fixed, they stay the
  /// same.
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  Eigen::Vector3d direction_sigma = Eigen::Vector3d::Ones();
  int observable_directions = 0;  ///< 0, 2 or 3

  double delay = 0;          ///< s; zero if unobservable
  double delay_sigma = 0.1;  ///< s
  bool delay_observable = false;

  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();  ///< rad/s, in the axes of the IMU
  Eigen::Vector3d gyroscope_bias_sigma = Eigen::Vector3d::Constant(kDegree);  ///< rad/s

  /// Whether the turns of the IMU fit those of the LiDAR under some mount, bias and delay. If they
  /// do not, nothing is observable. Also true if there is too little motion to contradict. Turns
  /// about one axis fit an IMU with a wrong sign too, under a large wrong correction.
  bool agrees = true;
  /// Median length of a turn of the IMU relative to that of the LiDAR: about 57 if rates in deg/s
  /// are read as rad/s. Zero if there is too little motion.
  double turn_ratio = 0;
  bool mirrored = false;  ///< an axis of the IMU has the wrong sign, thus agrees is false

  double residual = 0;           ///< median length of the residual rotation of a turn, rad
  std::size_t turns = 0;         ///< used: samples cover them (0 if turn_ratio contradicts)
  std::size_t moving_turns = 0;  ///< of these, over 0.2 degrees by the IMU

  bool rotation_observable() const { return observable_directions == 3; }
  /// Whether the present mount or clock is clearly wrong, so that it distorts maps: by over 0.75
  /// degrees or 7 ms, and over five deviations.
  bool is_off() const;
  /// Standard deviations about the axes of the LiDAR, rad.
  Eigen::Vector3d rotation_sigma() const { return rotation_covariance.diagonal().cwiseSqrt(); }
};

/// Estimates from turns of scans, with outliers, and the samples of a gyroscope. Any error of the
/// present mount converges, and delays of up to 0.25 s. A direction of the rotation is observable
/// with a standard deviation of up to 0.3 degrees, and the delay with up to 4 ms; both need ten
/// moving turns.
/// @param turns    in any order; a turn is a rotation of less than pi
/// @param samples  in strictly increasing time
ImuHandEye estimate_imu_hand_eye(std::vector<ScanTurn> turns, const std::vector<ImuSample>& samples,
                                 const Eigen::Matrix3d& R_lidar_imu);

/// The motion that makes all of an estimate observable, as a command; empty if all is observable,
/// or if IMU and LiDAR disagree.
std::string missing_motion(const ImuHandEye& estimate);

}  // namespace fovea
