// Edges of a scan, by LiDAR.
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/mapping/calibration/lidar_edges.h"

namespace fovea {

/// m: beyond it the spacing of beams exceeds most objects.
inline constexpr double kMaxEdgeRange = 40;

/// The edges that each LiDAR sees, in the LiDAR frame (find_lidar_edges), at the scan's stamp.
/// @param scan_lidar  without motion compensation
/// @param motion      of the LiDAR at the stamp; absent: the scan is compensated already
/// @param max_range   m, of objects
std::vector<LidarEdges> scan_edges(const PointCloud& scan_lidar, const Camera& camera,
                                   const DriveInfo& drive, const std::optional<SweepMotion>& motion,
                                   double max_range = kMaxEdgeRange);

}  // namespace fovea
