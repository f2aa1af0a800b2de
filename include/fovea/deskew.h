// Sweep motion: a raw scan takes 0.1 s, at 10 m/s that is 1 m (docs/method.md 1).
#pragma once

#include "fovea/point_cloud.h"
#include "fovea/sweep_motion.h"

namespace fovea {

/// Gives each point of a scan without times its time from the stamp (s), by its azimuth.
/// @param scan_sensor  frame of the LiDAR, as measured
FOVEA_API void add_point_times(PointCloud& scan_sensor, const SweepTiming& sweep);

/// Moves every point of a sweep to where it was in the LiDAR frame at the scan's stamp.
///
/// If the points have times, the function uses them and removes their column. Otherwise the azimuth
/// atan2(y, x) of a point gives its share of the sweep, and the share gives its time.
/// @param scan_lidar  points as measured, origin 0; std::invalid_argument for another
/// @param motion      of the LiDAR at the stamp
/// @param sweep       unused if points have times
FOVEA_API void compensate_sweep(PointCloud& scan_lidar, const SweepMotion& motion,
                                const SweepTiming& sweep);

}  // namespace fovea
