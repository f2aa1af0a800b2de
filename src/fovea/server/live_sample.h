// Selects the points of a tile for a live view: the first point of each cell.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/map/tile_map.h"

namespace fovea {

/// The selection of one tile, with 64 cells along its edge: 6 cm in a tile of 4 m.
class LiveSample {
 public:
  /// Selects from the points added since the last call. Begins anew if the tile has lost points.
  /// @return indices of the new selected points in the tile
  std::span<const std::uint32_t> more(const TilePoints& tile, double tile_size);

  /// All selected points, after more().
  const std::vector<std::uint32_t>& all() const { return chosen_; }

 private:
  bool has_lost_points(const TilePoints& tile) const;

  std::vector<bool> taken_;                         // by cell
  std::vector<std::uint32_t> chosen_;               // indices in the tile
  std::size_t looked_at_ = 0;                       // points of the tile
  Eigen::Vector3f last_ = Eigen::Vector3f::Zero();  // of these
};

/// Appends a section of a live message (docs/viewer-protocol.md).
/// @param tile   at `id`; null if the map has it no more
/// @param whole  the points replace all earlier points of the tile
void append_section(std::string& message, const TileId& id, const TilePoints* tile,
                    std::span<const std::uint32_t> points, bool whole);

/// The bytes before the sections.
std::string points_header(int frame, std::size_t sections);

}  // namespace fovea
