#include "fovea/map/packed_tile.h"

#include <fmt/format.h>

#include <stdexcept>

namespace fovea {

PackedTile pack_tile(const TileId& id, const TilePoints& tile) {
  tile.check();
  if (static_cast<std::int64_t>(tile.size()) > kMaxTilePoints || !tile.origin.allFinite()) {
    throw std::invalid_argument(fmt::format("tile {} {} {} has {} points and the origin {} {} {}",
                                            id.key.x, id.key.y, id.key.z, tile.size(),
                                            tile.origin.x(), tile.origin.y(), tile.origin.z()));
  }
  PackedTile packed;
  packed.id = id;
  packed.points = static_cast<std::int64_t>(tile.size());
  packed.colored = count_colored(tile);
  // Adding zero turns -0, which SQLite cannot keep, into 0.
  packed.origin = tile.origin.array() + 0.0;
  packed.columns = pack_columns(tile);
  return packed;
}

std::int64_t count_colored(const TilePoints& tile) {
  std::int64_t colored = 0;
  tile.camera.for_each_run([&](std::uint32_t begin, std::uint32_t end, std::int8_t camera) {
    if (camera != kNoCamera) colored += end - begin;
  });
  return colored;
}

}  // namespace fovea
