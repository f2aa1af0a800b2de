// Writes the tiles of several maps into one. Private to merging/.
#pragma once

#include <optional>

#include "fovea/map/map_store.h"

namespace fovea {

class TileOutput {
 public:
  /// @param writer  must outlive this
  explicit TileOutput(MapWriter& writer) : writer_(writer) {}

  /// A map has intensities in all tiles or in none: as the first tile has them.
  void put(const TileId& id, TilePoints tile) {
    if (!has_intensity_) has_intensity_ = !tile.intensity.empty();
    if (!*has_intensity_) tile.intensity = {};
    if (*has_intensity_ && tile.intensity.empty() && !tile.empty()) {
      tile.intensity.push_back(0.0f, static_cast<std::uint32_t>(tile.size()));
    }
    writer_.put_tile(id, tile);
  }

 private:
  MapWriter& writer_;
  std::optional<bool> has_intensity_;
};

}  // namespace fovea
