// The LiDAR: HDL-64E, a sweep while the vehicle drives.
#pragma once

#include <array>
#include <vector>

#include "fovea/simulation/ray_caster.h"
#include "fovea/simulation/rig.h"
#include "fovea/simulation/truth_point.h"
#include "fovea/simulation/vehicle_motion.h"

namespace fovea {

inline constexpr int kRings = 64;

/// Elevation of a beam (rad), 0 the highest: 32 from +2 by a third of a degree, 32 from -8.83 by
/// half of one (HDL-64E S2 data sheet).
double beam_elevation(int ring);

struct SimulatedScan {
  std::vector<std::array<float, 4>> points;  ///< x, y, z as measured (m, LiDAR), reflectance 0-1
  std::vector<TruthPoint> truth;             ///< of the same points
};

/// One sweep, clockwise seen from above, that faces forward at `stamp` (s): the firing at azimuth a
/// happens at stamp - a / (2 pi) * period, from where the LiDAR is then. Points by ring, in the
/// order of time.
/// @param frame  seeds the noise
SimulatedScan simulate_scan(const RayCaster& caster, const VehicleMotion& motion, const Rig& rig,
                            const LidarOptions& options, int seed, int frame, double stamp);

}  // namespace fovea
