// The points of a tile in the frame `local`.
#pragma once

#include <utility>

#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// @param tile  in the frame of its submap
/// @return with the origin 0
inline PointCloud points_in_local(PointCloud tile, const RigidMotion& T_local_submap) {
  const Eigen::Vector3d origin = std::exchange(tile.origin, Eigen::Vector3d::Zero());
  for (Eigen::Vector3f& p : tile.position) {
    p = (T_local_submap * (origin + p.cast<double>())).cast<float>();
  }
  return tile;
}

}  // namespace fovea
