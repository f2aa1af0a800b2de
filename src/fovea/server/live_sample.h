// The points of a tile that a live view is shown: one in each cell, chosen as they come.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fovea/map/tile_map.h"

namespace fovea {

/// Of one tile. 64 cells along its edge: 6 cm in a tile of 4 m.
class LiveSample {
 public:
  /// Looks at the points that have been added since the last call, the first in each cell. Where
  /// points have gone from the tile, it begins anew.
  /// @return their indices in the tile
  std::span<const std::uint32_t> more(const TilePoints& tile, double tile_size);

  /// All that are chosen, after more().
  const std::vector<std::uint32_t>& all() const { return chosen_; }

 private:
  bool has_lost_points(const TilePoints& tile) const;

  std::vector<bool> taken_;                         // by cell
  std::vector<std::uint32_t> chosen_;               // indices in the tile
  std::size_t looked_at_ = 0;                       // points of the tile
  Eigen::Vector3f last_ = Eigen::Vector3f::Zero();  // of these
};

/// Appends a section of a live message (docs/viewer-protocol.md).
/// @param tile   at `id`; nullptr for one that has gone
/// @param whole  the points are all that the tile has
void append_section(std::string& message, const TileId& id, const TilePoints* tile,
                    std::span<const std::uint32_t> points, bool whole);

/// What stands before the sections.
std::string points_header(int frame, std::size_t sections);

}  // namespace fovea
