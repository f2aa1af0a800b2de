// A sweep of the LiDAR while the vehicle drives.
#pragma once

#include <array>
#include <vector>

#include "fovea/simulation/ray_caster.h"
#include "fovea/simulation/rig.h"
#include "fovea/simulation/truth_point.h"
#include "fovea/simulation/vehicle_motion.h"

namespace fovea {

struct SimulatedScan {
  std::vector<std::array<float, 4>> points;  ///< x, y, z as measured (m, LiDAR), reflectance 0-1
  std::vector<TruthPoint> truth;             ///< of the same points
};

/// One sweep of the LiDAR that the options describe. Each firing leaves from where the LiDAR is at
/// that time. A rotating LiDAR turns clockwise, seen from above its own frame, and faces forward at
/// `stamp` (s); a rosette follows the time of the drive. Points by ring, in the order of time.
/// @param frame  seeds the noise
SimulatedScan simulate_scan(const RayCaster& caster, const VehicleMotion& motion,
                            const RigidMotion& T_vehicle_lidar, const LidarOptions& options,
                            int seed, int frame, double stamp);

}  // namespace fovea
