// A tile as the bytes of its columns: what is to be written of it, while the tile itself changes.
#pragma once

#include <cstdint>

#include "fovea/map/tile_columns.h"
#include "fovea/map/tile_map.h"

namespace fovea {

/// Points that one tile may hold; bounds what a damaged row can make a reader allocate.
inline constexpr std::int64_t kMaxTilePoints = std::int64_t{1} << 26;

struct PackedTile {
  TileId id;
  std::int64_t points = 0;
  std::int64_t colored = 0;  ///< points that a camera has colored
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  PackedColumns columns;
};

/// std::logic_error if columns have different lengths, std::invalid_argument if the tile has too
/// many points or an origin that is not finite.
PackedTile pack_tile(const TileId& id, const TilePoints& tile);

/// Points of a tile that a camera has colored.
std::int64_t count_colored(const TilePoints& tile);

}  // namespace fovea
