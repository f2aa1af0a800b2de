// Global search for the mount and the delay of an IMU on a LiDAR.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/gyroscope_orientation.h"

namespace fovea {

/// Rotation of a LiDAR between two scans, by registration.
struct ScanTurn {
  TimeNs begin = 0, end = 0;
  /// Rotation vector of R_begin_end (rad), in the LiDAR frame at `begin`.
  Eigen::Vector3d rotation_lidar = Eigen::Vector3d::Zero();
};

/// Stamps of the IMU that belong to a turn, if the right time of a sample is its stamp + delay (s).
struct StampInterval {
  TimeNs begin = 0, end = 0;
};
StampInterval imu_stamps(const ScanTurn& turn, double delay);

/// Standard deviation of each component of 3D residuals, from the median of their lengths (rad).
double robust_sigma(std::vector<double> lengths);

/// Weight of a residual by its length (rad): 1 up to 3.5 sigma, then falling with the third power.
double inlier_weight(double length, double sigma);

/// Mount and delay to a few milliseconds and about a degree.
struct CoarseHandEye {
  Eigen::Matrix3d R_lidar_imu = Eigen::Matrix3d::Identity();
  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();  ///< rad/s, in the axes of the IMU
  double delay = 0;                                          ///< s
  /// A reflection fits the turns clearly better than any rotation: one axis has the wrong sign.
  bool mirrored = false;
};

/// Compares delays of up to 0.25 s in steps of 5 ms. For each, finds the rotation and the bias in
/// closed form. Needs no initial guess.
CoarseHandEye search_hand_eye(const std::vector<ScanTurn>& turns,
                              const GyroscopeOrientation& gyroscope);

}  // namespace fovea
