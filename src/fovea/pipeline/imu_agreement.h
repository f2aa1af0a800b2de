// Whether an IMU tells the motion that the scans show.
#pragma once

#include <string>
#include <vector>

#include "fovea/rigid_motion.h"

namespace fovea {

/// Compares motions from frame to frame: as registered, as the IMU has them, and at constant
/// velocity. An IMU with a flipped axis, wrong units, mount or clock is worse than none.
class ImuAgreement {
 public:
  /// Motions since the last frame. Only frames that turn count.
  void add(const RigidMotion& registered, const RigidMotion& by_imu,
           const RigidMotion& by_velocity);

  /// The bias of the gyroscope that the scans ask for: from frame to frame, an axis with the wrong
  /// sign looks like a large bias.
  void add_bias(const Eigen::Vector3d& rate_bias);

  /// The IMU has told the turns of enough frames. Its prediction can weigh in the registration.
  bool is_proven() const;
  /// Constant velocity has told the turns better than the IMU, or its bias is one that no gyroscope
  /// has.
  bool is_contradicted() const;
  /// What is likely wrong with the IMU that is contradicted: its units, an axis, or the mount.
  std::string likely_fault() const;

 private:
  struct Turns {
    Eigen::Vector3d scans, imu;  // rotation vectors, LiDAR axes, rad
  };
  double frames_ = 0, error_imu_ = 0, error_velocity_ = 0;  // sums; older frames count less
  std::vector<Turns> turns_;                                // of the latest frames
  int gross_biases_ = 0;                                    // frames in a row
};

}  // namespace fovea
