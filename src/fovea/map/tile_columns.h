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

/// The bytes of each column, empty where the tile lacks it.
using PackedColumns = std::array<std::vector<std::byte>, kStoredColumns>;
PackedColumns pack_columns(const TilePoints& tile);

/// What a compressor should know of column i.
struct ColumnKind {
  std::size_t parts = 1;  ///< of one length, each with another kind of bytes
  bool is_noisy = false;  ///< bytes seldom come again in the same order
};
ColumnKind kind_of(std::size_t column);

/// Bytes that column i of so many points takes.
std::size_t packed_size(std::size_t column, std::size_t points);
/// Puts the packed bytes of column i, of the right size, into a tile of so many points.
void unpack_column(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                   TilePoints& tile);

}  // namespace fovea
