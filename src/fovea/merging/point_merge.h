// The points of two maps that lie in one frame, as the points of one map.
#pragma once

#include <cstddef>

#include "fovea/map/tile_cache.h"

namespace fovea {

struct PointMergeFigures {
  std::size_t added = 0;  ///< points of B that are new
  std::size_t known = 0;  ///< points of B on a surface that A has, and left out
  std::size_t fused = 0;  ///< points of A that got a color from B
};

/// Removes the points of the later of two maps where the earlier one knows the surface. Their
/// colors are fused into its points.
/// @param map      both, in one local frame: A's submaps, then B's; all tiles in `file`
/// @param first_b  B's first submap
/// @param spacing  of the points, m. Where no camera of A colored a surface, only B's points within
///                 this distance of A's are removed.
/// @param file     of the map; the last changes are not yet written
PointMergeFigures merge_points(TileMap& map, std::size_t first_b, double spacing,
                               Checkpointer& file, TileCache& cache);

}  // namespace fovea
