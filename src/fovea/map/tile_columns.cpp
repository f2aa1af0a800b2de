#include "fovea/map/tile_columns.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace fovea {
namespace {

// The columns are stored as they lie in memory; the format says little endian and packed.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Rgb) == 3);

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

constexpr std::size_t kPlaneBytes = 2;  // of a point

/// A plane of differences: all their lower bytes, then all their upper ones.
void pack_plane(const std::vector<std::uint16_t>& values, std::byte* bytes) {
  const std::size_t n = values.size();
  // By blocks of their own memory: the compiler then knows that nothing overlaps, and works on
  // sixteen values at a time.
  constexpr std::size_t kBlock = 256;
  std::array<std::uint16_t, kBlock> differences;
  std::array<std::byte, kBlock> lower, upper;
  std::uint16_t last = 0;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t count = std::min(kBlock, n - begin);
    const std::uint16_t* block = values.data() + begin;
    differences[0] = difference(last, block[0]);
    for (std::size_t i = 1; i < count; ++i) differences[i] = difference(block[i - 1], block[i]);
    for (std::size_t i = 0; i < count; ++i) {
      lower[i] = static_cast<std::byte>(differences[i] & 255);
      upper[i] = static_cast<std::byte>(differences[i] >> 8);
    }
    std::memcpy(bytes + begin, lower.data(), count);
    std::memcpy(bytes + n + begin, upper.data(), count);
    last = block[count - 1];
  }
}
void unpack_plane(std::size_t n, const std::byte* bytes, std::vector<std::uint16_t>& values) {
  values.resize(n);
  std::uint16_t last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    last =
        following(last, static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[i]) |
                                                   std::to_integer<unsigned>(bytes[n + i]) << 8));
    values[i] = last;
  }
}

/// A column as it is.
template <class Value>
void copy(const std::vector<Value>& values, std::vector<std::byte>& bytes) {
  bytes.resize(values.size() * sizeof(Value));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
}
template <class Value>
void copy(std::span<const std::byte> bytes, std::vector<Value>& values) {
  values.resize(bytes.size() / sizeof(Value));
  if (!bytes.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
}
template <class Value>
void copy(const RunColumn<Value>& column, std::vector<std::byte>& bytes) {
  bytes.resize(column.size() * sizeof(Value));
  std::byte* to = bytes.data();
  column.for_each_run([&](std::uint32_t begin, std::uint32_t end, Value value) {
    for (const std::byte* stop = to + (end - begin) * sizeof(Value); to < stop;
         to += sizeof(Value)) {
      std::memcpy(to, &value, sizeof(Value));
    }
  });
}
template <class Value>
void copy(std::span<const std::byte> bytes, RunColumn<Value>& column) {
  column = {};
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Value)) {
    Value value;
    std::memcpy(&value, &bytes[at], sizeof(Value));
    column.push_back(value);
  }
}

/// Calls `planes` with the columns that are planes of differences, a span of them, and `as_it_is`
/// with the others. Which they are is told by the tile's column itself.
template <class Tile, class Column, class Planes, class AsItIs>
void by_packing(Tile& tile, Column& column, Planes&& planes, AsItIs&& as_it_is) {
  if constexpr (std::is_same_v<std::remove_const_t<Column>, decltype(TilePoints::position)>) {
    planes(std::span(column));
  } else if constexpr (std::is_same_v<std::remove_const_t<Column>, decltype(TilePoints::range)>) {
    &column == &tile.range ? planes(std::span(&column, 1)) : as_it_is(column);
  } else {
    as_it_is(column);
  }
}

}  // namespace

PackedColumns pack_columns(const TilePoints& tile) {
  PackedColumns columns;
  const std::size_t n = tile.size();
  std::size_t next = 0;
  for_each_stored_column(tile, [&](const auto& column) {
    std::vector<std::byte>& bytes = columns[next++];
    by_packing(
        tile, column,
        [&](const auto& planes) {
          bytes.resize(planes.size() * kPlaneBytes * n);
          std::byte* to = bytes.data();
          for (const std::vector<std::uint16_t>& plane : planes) {
            pack_plane(plane, to);
            to += kPlaneBytes * n;
          }
        },
        [&](const auto& values) { copy(values, bytes); });
  });
  return columns;
}

ColumnKind kind_of(std::size_t column) {
  const TilePoints tile;
  std::size_t next = 0;
  ColumnKind kind;
  for_each_stored_column(tile, [&](const auto& of_tile) {
    if (next++ != column) return;
    const void* const it = &of_tile;
    kind.is_noisy = it == &tile.color || it == &tile.spread;
    by_packing(
        tile, of_tile,
        [&](const auto& planes) {
          kind = {planes.size() * kPlaneBytes, true};
        },
        [](const auto&) {});
  });
  return kind;
}

std::size_t packed_size(std::size_t column, std::size_t points) {
  const TilePoints tile;
  std::size_t next = 0, size = 0;
  for_each_stored_column(tile, [&](const auto& of_tile) {
    if (next++ != column) return;
    by_packing(
        tile, of_tile, [&](const auto& planes) { size = points * planes.size() * kPlaneBytes; },
        [&]<class Values>(const Values&) { size = points * sizeof(typename Values::value_type); });
  });
  return size;
}

void unpack_column(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                   TilePoints& tile) {
  std::size_t next = 0;
  for_each_stored_column(tile, [&](auto& of_tile) {
    if (next++ != column) return;
    by_packing(
        tile, of_tile,
        [&](const auto& planes) {
          const std::byte* from = bytes.data();
          for (std::vector<std::uint16_t>& plane : planes) {
            unpack_plane(points, from, plane);
            from += kPlaneBytes * points;
          }
        },
        [&](auto& values) { copy(bytes, values); });
  });
}

}  // namespace fovea
