// A LiDAR that looks at a map.
#pragma once

#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/rigid_motion.h"
#include "fovea/rendering/map_window.h"

namespace fovea {

/// Where a LiDAR's beams go.
struct LidarPattern {
  std::vector<double> elevation;        ///< rad, of its beams, the highest first
  int columns = 0;                      ///< firings a turn
  double min_range = 0, max_range = 0;  ///< m
};

/// Velodyne HDL-64E S2 (its data sheet; KITTI's): 32 beams from +2 degrees by a third of one, 32
/// from -8.83 by half of one, 2083 firings.
LidarPattern hdl64();

/// The scan that a LiDAR takes that stands at a pose: of each beam the first disc that it meets,
/// and of discs of one surface the mean, each by how centrally it is met. No noise, nothing lost,
/// no motion; a beam that meets nothing gives no point.
/// @return LiDAR frame, with intensity; by beam from the highest, clockwise from behind
PointCloud cast_lidar(const MapSurfels& map, const RigidMotion& T_local_lidar,
                      const LidarPattern& pattern);

}  // namespace fovea
