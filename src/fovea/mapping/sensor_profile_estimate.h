// Estimates the scan pattern of a LiDAR from its first scans, for drives that do not state it.
#pragma once

#include <span>

#include "fovea/geometry/sensor_profile.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Estimates rings, spacing, range noise and height of a LiDAR.
///
/// Rings come from the column `ring` of the scans. Without it they come from the order of points if
/// the scans list ring after ring, or else from clusters of elevations. Scans without rings, such
/// as those of a Livox, give a profile without rings; both spacings are then the mean angle between
/// neighboring points.
///
/// @param scans   LiDAR frame, as measured; a few suffice
/// @param stated  from the drive: its name and sweep are kept
SensorProfile estimate_sensor_profile(std::span<const PointCloud> scans,
                                      const SensorProfile& stated);

}  // namespace fovea
