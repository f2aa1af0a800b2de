// What a tile keeps of its points' numbers, and how its columns lie in the file before compression
// (docs/map-format.md). Private to map/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/point_cloud.h"

namespace fovea {

/// Calls `f(column)` for each column of a tile that is stored, in the order of the table.
template <class Cloud, class F>
void for_each_stored_column(Cloud& tile, F&& f) {
  f(tile.position);
  f(tile.color);
  f(tile.camera);
  f(tile.frame);
  f(tile.range);
  f(tile.incidence);
  f(tile.interpolated);
  f(tile.views);
  f(tile.spread);
  f(tile.weight);
  f(tile.reason);
  f(tile.intensity);
}
inline constexpr std::size_t kStoredColumns = 12;
inline constexpr std::size_t kIntensityColumn = 11;  // the only one that may be missing

/// Steps of what is kept coarser than a float: finer than any sensor knows it, and a fraction of
/// the size.
inline constexpr float kPositionStep = 0.001f;         // m
inline constexpr float kRangeStep = 0.01f;             // m
inline constexpr float kIncidenceStep = 0.008726646f;  // rad: half a degree
/// Largest edge of a tile whose points the steps reach, m.
inline constexpr double kMaxTileSize = 65.5;

/// Rounds to what the file keeps, so that a point does not change when its tile is written and read
/// again. Out of range, the nearest that can be kept; an unknown incidence stays NaN.
Eigen::Vector3f kept_position(const Eigen::Vector3d& p_tile);
float kept_range(float range);
float kept_incidence(float incidence);

/// The bytes of each column, empty where the tile lacks it.
using PackedColumns = std::array<std::vector<std::byte>, kStoredColumns>;
PackedColumns pack_columns(const PointCloud& tile);

/// Bytes that column i of so many points takes.
std::size_t packed_size(std::size_t column, std::size_t points);
/// Puts the packed bytes of column i, of the right size, into a tile of so many points.
void unpack_column(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                   PointCloud& tile);

}  // namespace fovea
