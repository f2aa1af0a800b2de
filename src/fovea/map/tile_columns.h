// How the columns of a tile lie in the file before compression (docs/map-format.md). Private to
// map/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/map/tile_points.h"

namespace fovea {

/// The bytes of each column. Those of an optional column are empty if the tile lacks it, or if it
/// is 0 for every point of a tile whose column may be empty for that reason.
using PackedColumns = std::array<std::vector<std::byte>, kStoredColumns>;
PackedColumns pack_columns(const TilePoints& tile);

/// What a compressor should know of column i.
struct ColumnKind {
  std::size_t parts = 1;  ///< of one length, each with another kind of bytes
  bool is_noisy = false;  ///< bytes seldom come again in the same order
};
ColumnKind kind_of(std::size_t column);

/// Bytes that a column may take: from the least to the most, by steps.
struct PackedSizes {
  std::size_t least = 0, most = 0, step = 1;

  bool allow(std::size_t size) const {
    return size >= least && size <= most && (size - least) % step == 0;
  }
};
/// Of column i of so many points.
PackedSizes packed_sizes(std::size_t column, std::size_t points);
/// Puts the packed bytes of column i, of an allowed size, into a tile of so many points.
/// @return whether they are of so many
bool unpack_column(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                   TilePoints& tile);

}  // namespace fovea
