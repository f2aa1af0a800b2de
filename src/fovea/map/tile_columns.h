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

/// Bytes that column i of so many points takes.
std::size_t packed_size(std::size_t column, std::size_t points);
/// Puts the packed bytes of column i, of the right size, into a tile of so many points.
void unpack_column(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                   TilePoints& tile);

}  // namespace fovea
