// How much of a map contradicts a scan.
#pragma once

#include <limits>

#include "fovea/geometry/rigid_motion.h"
#include "fovea/mapping/range_image.h"
#include "fovea/mapping/registration/registration.h"

namespace fovea {

/// The share of the map's vertical surfaces in view, up to 30 m from the sensor, that the scan sees
/// through.
/// @param target  surfaces of the map
/// @param image   of the scan
/// @param lowest  surfaces below do not count: height above the sensor, m
double seen_through(const RegistrationCloud& target, const RangeImage& image,
                    const RigidMotion& T_target_lidar,
                    float lowest = std::numeric_limits<float>::lowest());

}  // namespace fovea
