// Which tile of a submap each of many points lies in, and where there.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "fovea/map/tile_map.h"

namespace fovea {

/// Points of a cloud by tiles, at the places that tiles keep.
struct PointsInTiles {
  TilePlaces position;                                       ///< of each point
  std::map<TileKey, std::vector<TilePoints::Range>> ranges;  ///< of the points of each tile
};

/// @param T_submap_points  from the points' frame, whose origin is near them, to a submap's
/// @param tile_size        edge of a tile, m
/// std::invalid_argument for a point that is not finite or further away than a tile's key can say.
PointsInTiles points_in_tiles(std::span<const Eigen::Vector3f> points,
                              const RigidMotion& T_submap_points, double tile_size);

}  // namespace fovea
