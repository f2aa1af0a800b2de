// A LiDAR that looks at a map.
#pragma once

#include <optional>
#include <vector>

#include "fovea/geometry/lidar_data_sheet.h"
#include "fovea/point_cloud.h"
#include "fovea/rendering/map_window.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// Where a LiDAR's beams go.
struct LidarPattern {
  std::vector<double> elevation;        ///< rad, of its rings, highest first; a rosette has one: 0
  std::optional<Rosette> rosette;       ///< absent: every ring has a beam in every column
  int columns = 0;                      ///< firings a sweep
  double period = 0.1;                  ///< s, of a sweep
  double min_range = 0, max_range = 0;  ///< m
};

/// The pattern of a LiDAR's data sheet.
LidarPattern lidar_pattern(LidarModel model);

/// The scan that a LiDAR takes that stands at a pose: of each beam the first disc that it meets,
/// and of discs of one surface the mean, each by how centrally it is met. No noise, nothing lost,
/// no motion; a beam that meets nothing gives no point.
/// @param time  s, of the middle of the sweep: where a rosette is; others are the same at any time
/// @return LiDAR frame, with intensity; by beam from the highest, clockwise from behind, or in the
///         order in which a rosette draws them
PointCloud cast_lidar(const MapSurfels& map, const RigidMotion& T_local_lidar,
                      const LidarPattern& pattern, double time = 0);

}  // namespace fovea
