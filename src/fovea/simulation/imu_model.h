// What an IMU measures: angular rates and specific force, with errors.
#pragma once

#include <vector>

#include "fovea/simulation/rig.h"
#include "fovea/simulation/simulation_options.h"
#include "fovea/simulation/vehicle_motion.h"
#include "fovea/time.h"

namespace fovea {

/// A measurement of an IMU or of a wheel, as a drive has it.
struct ImuRecord {
  TimeNs time = 0;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< rad/s or ImuOptions::in_degrees
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< m/s^2 or ImuOptions::in_g; up at rest
};
struct WheelRecord {
  TimeNs time = 0;
  double speed = 0;  ///< m/s, forward
};

/// Records from the start of the first sweep to the end of the last one, at options.imu.rate. Each
/// value is that of a moment. Biases walk; noise is white; see ImuOptions for planted faults.
std::vector<ImuRecord> simulate_imu(const VehicleMotion& motion, const Rig& rig,
                                    const SimulationOptions& options);

/// Records of the wheels' speed over the same time, at options.wheels.rate.
std::vector<WheelRecord> simulate_wheels(const VehicleMotion& motion, const Rig& rig,
                                         const SimulationOptions& options);

}  // namespace fovea
