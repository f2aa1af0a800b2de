// What an IMU has measured, and how well it measures.
#pragma once

#include <vector>

#include "fovea/core/angle.h"
#include "fovea/rigid_motion.h"
#include "fovea/time.h"

namespace fovea {

/// A measurement in the axes of the IMU.
struct ImuSample {
  TimeNs time = 0;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< angular velocity, rad/s
  /// Acceleration less gravity, m/s^2: points up with 9.8 m/s^2 at rest.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

/// Noise densities and random walks of the biases, as Kalibr has them. The defaults are those of a
/// consumer's IMU with a margin for vibration.
struct ImuNoise {
  double gyroscope_noise_density = 1e-3;      ///< rad/s per root Hz
  double gyroscope_random_walk = 5e-5;        ///< rad/s^2 per root Hz
  double accelerometer_noise_density = 1e-2;  ///< m/s^2 per root Hz
  double accelerometer_random_walk = 5e-4;    ///< m/s^3 per root Hz
};

struct ImuData {
  RigidMotion T_lidar_imu = RigidMotion::Identity();
  ImuNoise noise;
  std::vector<ImuSample> samples;  ///< in strictly increasing time
};

/// The speed of a vehicle's wheels.
struct WheelSpeed {
  TimeNs time = 0;
  double speed = 0;  ///< m/s, forward
};

struct WheelData {
  RigidMotion T_lidar_body = RigidMotion::Identity();  ///< body: x points forward
  double sigma = 0.1;                                  ///< m/s, standard deviation of a speed
  std::vector<WheelSpeed> samples;                     ///< in strictly increasing time
};

}  // namespace fovea
