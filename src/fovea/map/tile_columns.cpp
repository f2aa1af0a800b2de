#include "fovea/map/tile_columns.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace fovea {
namespace {

// The columns are stored as they lie in memory; the format says little endian and packed.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Eigen::Vector3f) == 12 && sizeof(Rgb) == 3);

constexpr std::uint8_t kUnknownIncidence = 255;

/// Steps of a value in what an unsigned number can hold; 0 of NaN.
template <class Number>
Number steps(double value, double step, Number most) {
  // std::round would be a call; a step is known to the compiler, which divides once by it.
  const double count = std::floor(value * (1 / step) + 0.5);
  if (!(count > 0)) return 0;
  return count < most ? static_cast<Number>(count) : most;
}

constexpr std::uint16_t kMost16 = std::numeric_limits<std::uint16_t>::max();

std::uint16_t position_steps(double p) { return steps(p, double(kPositionStep), kMost16); }
std::uint16_t range_steps(float range) { return steps(range, double(kRangeStep), kMost16); }
std::uint8_t incidence_steps(float incidence) {
  if (std::isnan(incidence)) return kUnknownIncidence;
  return steps<std::uint8_t>(incidence, double(kIncidenceStep), kUnknownIncidence - 1);
}

float position_of(std::uint16_t steps) { return float(steps) * kPositionStep; }
float range_of(std::uint16_t steps) { return float(steps) * kRangeStep; }
float incidence_of(std::uint8_t steps) {
  return steps == kUnknownIncidence ? std::numeric_limits<float>::quiet_NaN()
                                    : float(steps) * kIncidenceStep;
}

/// Neighbours in a tile are neighbours in space: their differences are small and compress well. An
/// even number is a difference of half of it, an odd one of minus half of the next.
std::uint16_t difference(std::uint16_t from, std::uint16_t to) {
  const auto d = static_cast<std::int16_t>(static_cast<std::uint16_t>(to - from));
  return static_cast<std::uint16_t>((static_cast<unsigned>(d) << 1) ^
                                    static_cast<unsigned>(d >> 15));
}
std::uint16_t following(std::uint16_t from, std::uint16_t difference) {
  const unsigned d = (difference >> 1) ^ (0u - (difference & 1u));
  return static_cast<std::uint16_t>(from + d);
}

/// A plane of n differences: all their lower bytes, then all their upper ones.
template <class At>
void pack_plane(std::size_t n, At&& at, std::byte* bytes) {
  std::uint16_t last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint16_t value = at(i), d = difference(last, value);
    bytes[i] = static_cast<std::byte>(d & 255);
    bytes[n + i] = static_cast<std::byte>(d >> 8);
    last = value;
  }
}
template <class Put>
void unpack_plane(std::size_t n, const std::byte* bytes, Put&& put) {
  std::uint16_t last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    last =
        following(last, static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[i]) |
                                                   std::to_integer<unsigned>(bytes[n + i]) << 8));
    put(i, last);
  }
}

enum class Packing { kPosition, kRange, kIncidence, kAsItIs };

/// What is packed otherwise than as it lies in memory is told by the tile's column itself.
template <class Column>
Packing packing_of(const PointCloud& tile, const Column& column) {
  const void* address = &column;
  if (address == &tile.position) return Packing::kPosition;
  if (address == &tile.range) return Packing::kRange;
  if (address == &tile.incidence) return Packing::kIncidence;
  return Packing::kAsItIs;
}

std::size_t bytes_per_point(Packing packing, std::size_t in_memory) {
  switch (packing) {
    case Packing::kPosition:
      return 6;
    case Packing::kRange:
      return 2;
    case Packing::kIncidence:
      return 1;
    case Packing::kAsItIs:
      break;
  }
  return in_memory;
}

}  // namespace

Eigen::Vector3f kept_position(const Eigen::Vector3d& p_tile) {
  return {position_of(position_steps(p_tile.x())), position_of(position_steps(p_tile.y())),
          position_of(position_steps(p_tile.z()))};
}
float kept_range(float range) { return range_of(range_steps(range)); }
float kept_incidence(float incidence) { return incidence_of(incidence_steps(incidence)); }

PackedColumns pack_columns(const PointCloud& tile) {
  PackedColumns columns;
  const std::size_t n = tile.size();
  std::size_t next = 0;
  for_each_stored_column(tile, [&](const auto& column) {
    std::vector<std::byte>& bytes = columns[next++];
    const Packing packing = packing_of(tile, column);
    bytes.resize(column.size() * bytes_per_point(packing, sizeof(column[0])));
    switch (packing) {
      case Packing::kPosition:
        for (int axis = 0; axis < 3; ++axis) {
          pack_plane(
              n, [&](std::size_t i) { return position_steps(tile.position[i][axis]); },
              bytes.data() + std::size_t(axis) * 2 * n);
        }
        break;
      case Packing::kRange:
        pack_plane(
            n, [&](std::size_t i) { return range_steps(tile.range[i]); }, bytes.data());
        break;
      case Packing::kIncidence:
        std::transform(tile.incidence.begin(), tile.incidence.end(), bytes.begin(),
                       [](float incidence) { return std::byte{incidence_steps(incidence)}; });
        break;
      case Packing::kAsItIs:
        if (!bytes.empty()) std::memcpy(bytes.data(), column.data(), bytes.size());
    }
  });
  return columns;
}

std::size_t packed_size(std::size_t column, std::size_t points) {
  const PointCloud tile;
  std::size_t next = 0, size = 0;
  for_each_stored_column(tile, [&](const auto& of_tile) {
    if (next++ == column) {
      size = points * bytes_per_point(packing_of(tile, of_tile), sizeof(of_tile[0]));
    }
  });
  return size;
}

void unpack_column(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                   PointCloud& tile) {
  std::size_t next = 0;
  for_each_stored_column(tile, [&](auto& values) {
    if (next++ != column) return;
    values.resize(points);
    switch (packing_of(tile, values)) {
      case Packing::kPosition:
        for (int axis = 0; axis < 3; ++axis) {
          unpack_plane(points, bytes.data() + std::size_t(axis) * 2 * points,
                       [&](std::size_t i, std::uint16_t steps) {
                         tile.position[i][axis] = position_of(steps);
                       });
        }
        break;
      case Packing::kRange:
        unpack_plane(points, bytes.data(),
                     [&](std::size_t i, std::uint16_t steps) { tile.range[i] = range_of(steps); });
        break;
      case Packing::kIncidence:
        std::transform(bytes.begin(), bytes.end(), tile.incidence.begin(), [](std::byte steps) {
          return incidence_of(std::to_integer<std::uint8_t>(steps));
        });
        break;
      case Packing::kAsItIs:
        if (points > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    }
  });
}

}  // namespace fovea
