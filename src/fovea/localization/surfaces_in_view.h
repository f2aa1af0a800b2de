// How much of a map contradicts a scan.
#pragma once

#include <cstddef>
#include <limits>

#include "fovea/mapping/range_image.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// Vertical surfaces of a map in view, up to 30 m from the sensor.
struct SurfacesInView {
  std::size_t seen = 0;     ///< the scan has them, too
  std::size_t through = 0;  ///< the scan sees through them

  std::size_t count() const { return seen + through; }
  /// 0 if there are none.
  double share_through() const { return through > 0 ? double(through) / double(count()) : 0; }
};

/// @param target  surfaces of the map; its z axis points up
/// @param image   of the scan
/// @param lowest  surfaces below do not count: height above the sensor, m
SurfacesInView surfaces_in_view(const RegistrationCloud& target, const RangeImage& image,
                                const RigidMotion& T_target_lidar,
                                float lowest = std::numeric_limits<float>::lowest());

}  // namespace fovea
