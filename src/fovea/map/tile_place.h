// Where the points of a tile may lie.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "fovea/map/tile_map.h"

namespace fovea {

/// Middle of a tile in its submap's frame, and how far from there its points may lie, m.
inline Eigen::Vector3d middle_of(const TileKey& key, double tile_size) {
  return tile_size * (Eigen::Vector3d(key.x, key.y, key.z) + Eigen::Vector3d::Constant(0.5));
}
inline double reach_of_tile(double tile_size) { return tile_size / 2 * std::sqrt(3.0) + 0.01; }

}  // namespace fovea
