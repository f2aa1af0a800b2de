// Edges of objects in a LiDAR scan: jumps of range between neighboring beams.
#pragma once

#include <vector>

#include "fovea/camera.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Edges of a scan. Entry i of both clouds is one edge: the last beam that hit the near object, and
/// the neighboring beam that passed it. Both have the object's range. The expected edge is in the
/// middle. (The near beam alone would be inside by half the spacing of beams.)
struct LidarEdges {
  PointCloud inside, outside;               ///< with the times of their beams if the scan has times
  std::vector<std::uint8_t> between_rings;  ///< 1: beams of neighboring rings, 0: of one ring
  double ring_spacing = 0;  ///< rad: median angle between neighboring rings in view; 0: of one ring
  std::size_t size() const { return inside.size(); }
};

/// Finds jumps between consecutive points of a ring, and between points above each other in
/// neighboring rings.
/// @param scan_lidar  without motion compensation, so that directions are those of the beams. Each
///                    ring in the order of time, ring after ring (as in KITTI's files) or with the
///                    numbers of the rings; otherwise it finds only jumps between rings
/// @param camera      limits the search to its view and the surroundings
/// @param max_range   m, of the near object
LidarEdges find_lidar_edges(const PointCloud& scan_lidar, const Camera& camera, double max_range);

}  // namespace fovea
