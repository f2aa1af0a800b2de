// Sweep motion: a raw scan takes 0.1 s, at 10 m/s that is 1 m (docs/method.md 1).
#pragma once

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/sweep_motion.h"

namespace fovea {

/// Moves every point of a sweep to where it was in the LiDAR frame at the scan's stamp.
///
/// Where the scan has the points' times, these are used up: the column is gone afterwards. Where it
/// has none, the sweep turns clockwise seen from above and faces forward at the stamp, its middle:
/// a point at azimuth a = atan2(y, x) was measured at stamp - a / (2 pi) * period.
/// @param scan_lidar  points as measured, origin 0; std::invalid_argument for another
/// @param motion      of the LiDAR at the stamp
/// @param period      s, duration of the sweep; unused where points have times
void compensate_sweep(PointCloud& scan_lidar, const SweepMotion& motion, double period);

}  // namespace fovea
