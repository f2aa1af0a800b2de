// The points of two maps that lie in one frame, as the points of one map.
#pragma once

#include <cstddef>

#include "fovea/map/map_keeper.h"

namespace fovea {

struct PointMergeFigures {
  std::size_t added = 0;  ///< points of B that are new
  std::size_t known = 0;  ///< points of B on a surface that A has, and left out
  std::size_t fused = 0;  ///< points of A whose colours B's went into
};

/// Removes the points of the later of two maps where the earlier one knows the surface, and fuses
/// their colours into its points.
/// @param map      both, in one local frame: A's submaps, then B's; all tiles in the keeper's file
/// @param first_b  B's first submap
/// @param spacing  of the points, m: of a surface that A knows but no camera of its own has
///                 coloured, B's points stay unless they are as near as this
/// @param keeper   of the map; no change is committed yet when it returns
PointMergeFigures merge_points(TileMap& map, std::size_t first_b, double spacing,
                               MapKeeper& keeper);

}  // namespace fovea
