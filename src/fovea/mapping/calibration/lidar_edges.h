// Where things end, as a LiDAR sees it: jumps of range between neighbouring beams.
#pragma once

#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"

namespace fovea {

/// Edges of a scan, entry i of both clouds one edge: a beam that still met the near thing and the
/// neighbouring one that passed it, both at the near thing's range. The thing ends somewhere
/// between the two; the middle is where it is expected to (the near beam alone would lie inside by
/// half the spacing of beams, on either side of the thing).
struct LidarEdges {
  PointCloud inside, outside;  ///< with the times of their beams where the scan has them
  std::vector<std::uint8_t> between_rings;  ///< 1: the beams are of neighbouring rings, 0: of one
  double ring_spacing = 0;  ///< rad: median angle between neighboring rings in view; 0: of one ring
  std::size_t size() const { return inside.size(); }
};

/// Finds jumps between points that follow each other in a ring, and between points above each other
/// in neighbouring rings.
/// @param scan_lidar  as measured (no motion compensation: directions must be the beams'), each
///                    ring's points in the order of time, as KITTI's files have them; in any other
///                    order only jumps between rings are found
/// @param camera      only what lies before it, and in its view or near that, is looked at
/// @param max_range   m, of the near thing
LidarEdges find_lidar_edges(const PointCloud& scan_lidar, const Camera& camera, double max_range);

}  // namespace fovea
