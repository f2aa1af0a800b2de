#include "fovea/map/tile_columns.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "fovea/map/value_plane.h"

namespace fovea {
namespace {

// The columns are stored as they lie in memory; the format says little endian and packed.
static_assert(std::endian::native == std::endian::little);

template <class Column>
inline constexpr bool kIsRuns = false;
template <class Value>
inline constexpr bool kIsRuns<RunColumn<Value>> = true;

template <class Column>
inline constexpr bool kIsColors = false;
template <class Colors>
inline constexpr bool kIsColors<ColorColumn<Colors, &FusedColor::color>> = true;

/// Mostly 0 for each point: runs in the file.
template <class Column>
inline constexpr bool kIsSaturated = false;
template <class Colors>
inline constexpr bool kIsSaturated<ColorColumn<Colors, &FusedColor::saturated>> = true;

RunColumn<std::uint8_t> saturated_of(const std::vector<FusedColor>& colors) {
  RunColumn<std::uint8_t> saturated;
  for (const FusedColor& color : colors) saturated.push_back(color.saturated, 1);
  return saturated;
}
void put_saturated(const RunColumn<std::uint8_t>& saturated, std::vector<FusedColor>& colors) {
  saturated.for_each_run([&](std::uint32_t begin, std::uint32_t end, std::uint8_t value) {
    for (std::uint32_t i = begin; i < end; ++i) colors[i].saturated = value;
  });
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
template <class Colors, auto kPart>
void copy(const ColorColumn<Colors, kPart>& column, std::vector<std::byte>& bytes) {
  constexpr std::size_t kSize = sizeof(typename ColorColumn<Colors, kPart>::value_type);
  bytes.resize(column.colors.size() * kSize);
  std::byte* to = bytes.data();
  for (const FusedColor& color : column.colors) {
    std::memcpy(to, &(color.*kPart), kSize);
    to += kSize;
  }
}
template <class Colors, auto kPart>
void copy(std::span<const std::byte> bytes, const ColorColumn<Colors, kPart>& column) {
  constexpr std::size_t kSize = sizeof(typename ColorColumn<Colors, kPart>::value_type);
  column.colors.resize(bytes.size() / kSize);
  const std::byte* from = bytes.data();
  for (FusedColor& color : column.colors) {
    std::memcpy(&(color.*kPart), from, kSize);
    from += kSize;
  }
}

// The codes of green, and of red and blue relative to green, each as a plane: colors are mostly
// gray, and neighbors are alike.
constexpr std::size_t kChannels = 3;

void pack_colors(const std::vector<FusedColor>& colors, std::vector<std::byte>& bytes) {
  std::array<std::vector<std::uint16_t>, kChannels> planes;
  for (std::vector<std::uint16_t>& plane : planes) plane.resize(colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto& [red, green, blue] = colors[i].color.code;
    planes[0][i] = green;
    planes[1][i] = static_cast<std::uint16_t>(red - green);
    planes[2][i] = static_cast<std::uint16_t>(blue - green);
  }
  bytes.resize(kChannels * kPlaneBytes * colors.size());
  std::byte* to = bytes.data();
  for (const std::vector<std::uint16_t>& plane : planes) {
    pack_plane(plane, to);
    to += kPlaneBytes * colors.size();
  }
}
/// @return whether all codes are within their range
bool unpack_colors(std::size_t n, const std::byte* bytes, std::vector<FusedColor>& colors) {
  std::array<std::vector<std::uint16_t>, kChannels> planes;
  for (std::vector<std::uint16_t>& plane : planes) {
    unpack_plane(n, bytes, plane);
    bytes += kPlaneBytes * n;
  }
  colors.resize(n);
  unsigned largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint16_t green = planes[0][i];
    const auto red = static_cast<std::uint16_t>(planes[1][i] + green);
    const auto blue = static_cast<std::uint16_t>(planes[2][i] + green);
    largest = std::max({largest, unsigned{red}, unsigned{green}, unsigned{blue}});
    colors[i].color = LogColor::of_codes(red, green, blue);
  }
  return largest <= unsigned{kMaxColorCode};
}

/// Bytes of a run: its value, and one less than its length.
template <class Value>
constexpr std::size_t kRunBytes = sizeof(Value) + 1;
constexpr std::uint32_t kLongestRun = 256;

/// Calls f(length, value) for each run; longer ones than a byte can tell come in several.
template <class Value, class F>
void for_each_short_run(const RunColumn<Value>& column, F&& f) {
  column.for_each_run([&](std::uint32_t begin, std::uint32_t end, Value value) {
    for (; begin < end; begin += kLongestRun) f(std::min(kLongestRun, end - begin), value);
  });
}

/// The first bytes of all values, and so on, then all lengths.
template <class Value>
void pack_runs(const RunColumn<Value>& column, std::vector<std::byte>& bytes) {
  std::size_t runs = 0, next = 0;
  for_each_short_run(column, [&](std::uint32_t, Value) { ++runs; });
  bytes.resize(runs * kRunBytes<Value>);
  for_each_short_run(column, [&](std::uint32_t length, Value value) {
    const auto of_value = std::bit_cast<std::array<std::byte, sizeof(Value)>>(value);
    for (std::size_t k = 0; k < sizeof(Value); ++k) bytes[k * runs + next] = of_value[k];
    bytes[sizeof(Value) * runs + next++] = static_cast<std::byte>(length - 1);
  });
}
template <class Value>
bool unpack_runs(std::size_t n, std::span<const std::byte> bytes, RunColumn<Value>& column) {
  column = {};
  const std::size_t runs = bytes.size() / kRunBytes<Value>;
  std::array<std::byte, sizeof(Value)> of_value;
  std::size_t values = 0;
  for (std::size_t i = 0; i < runs; ++i) {
    for (std::size_t k = 0; k < sizeof(Value); ++k) of_value[k] = bytes[k * runs + i];
    const auto length = std::to_integer<std::uint32_t>(bytes[sizeof(Value) * runs + i]) + 1;
    values += length;
    if (values > n) return false;
    column.push_back(std::bit_cast<Value>(of_value), length);
  }
  return values == n;
}

/// Calls `planes` with a span of the columns that are planes of differences, `colors` with the
/// colors, `runs` with a column of runs of equal values, and `as_it_is` with any other column. The
/// type and place of the tile's column decide.
template <class Tile, class Column, class Planes, class Color, class Runs, class AsItIs>
void by_packing(Tile& tile, Column& column, Planes&& planes, Color&& colors, Runs&& runs,
                AsItIs&& as_it_is) {
  using Values = std::remove_const_t<Column>;
  if constexpr (std::is_same_v<Values, decltype(TilePoints::position)>) {
    planes(std::span(column));
  } else if constexpr (std::is_same_v<Values, decltype(TilePoints::range)>) {
    &column == &tile.range ? planes(std::span(&column, 1)) : as_it_is(column);
  } else if constexpr (kIsColors<Values>) {
    colors(column.colors);
  } else if constexpr (kIsSaturated<Values>) {
    if constexpr (std::is_const_v<Tile>) {
      const RunColumn<std::uint8_t> saturated = saturated_of(column.colors);
      runs(saturated);
    } else {
      RunColumn<std::uint8_t> saturated;
      runs(saturated);
      put_saturated(saturated, column.colors);
    }
  } else if constexpr (kIsRuns<Values>) {
    runs(column);
  } else {
    as_it_is(column);
  }
}

template <class Value>
bool is_zero(const RunColumn<Value>& column) {
  return std::all_of(column.runs().begin(), column.runs().end(),
                     [](const auto& run) { return run.value == Value{}; });
}

/// Calls f with column i of a tile.
template <class Tile, class F>
void with_column(Tile& tile, std::size_t i, F&& f) {
  std::size_t next = 0;
  for_each_stored_column(tile, [&](auto&& column) {
    if (next++ == i) f(column);
  });
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
        [&](const auto& colors) { pack_colors(colors, bytes); },
        [&](const auto& runs) { pack_runs(runs, bytes); },
        [&](const auto& values) { copy(values, bytes); });
  });
  if (is_zero(saturated_of(tile.colors))) columns[kSaturatedColumn].clear();
  next = kFirstDefaultColumn;
  for_each_default_column(tile, [&](const auto& column) {
    if (is_zero(column)) columns[next].clear();
    ++next;
  });
  return columns;
}

ColumnKind kind_of(std::size_t column) {
  const TilePoints tile;
  ColumnKind kind;
  with_column(tile, column, [&](const auto& of_tile) {
    by_packing(
        tile, of_tile, [&](const auto& planes) { kind = {planes.size() * kPlaneBytes, true}; },
        [&](const auto&) { kind = {kChannels * kPlaneBytes, true}; },
        [&]<class Value>(const RunColumn<Value>&) { kind.parts = kRunBytes<Value>; },
        [&]<class Values>(const Values&) {
          using Colors = const std::vector<FusedColor>;
          kind.is_noisy = std::is_same_v<Values, ColorColumn<Colors, &FusedColor::spread>>;
        });
  });
  return kind;
}

PackedSizes packed_sizes(std::size_t column, std::size_t points) {
  const TilePoints tile;
  PackedSizes sizes;
  with_column(tile, column, [&](const auto& of_tile) {
    by_packing(
        tile, of_tile,
        [&](const auto& planes) {
          sizes.least = sizes.most = points * planes.size() * kPlaneBytes;
        },
        [&](const auto&) { sizes.least = sizes.most = points * kChannels * kPlaneBytes; },
        [&]<class Value>(const RunColumn<Value>&) {
          sizes.step = kRunBytes<Value>;
          sizes.least = (points + kLongestRun - 1) / kLongestRun * sizes.step;
          sizes.most = points * sizes.step;
        },
        [&]<class Values>(const Values&) {
          sizes.least = sizes.most = points * sizeof(typename Values::value_type);
        });
  });
  return sizes;
}

bool unpack_column(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                   TilePoints& tile) {
  bool is_whole = true;
  with_column(tile, column, [&](auto& of_tile) {
    by_packing(
        tile, of_tile,
        [&](const auto& planes) {
          const std::byte* from = bytes.data();
          for (std::vector<std::uint16_t>& plane : planes) {
            unpack_plane(points, from, plane);
            from += kPlaneBytes * points;
          }
        },
        [&](auto& colors) { is_whole = unpack_colors(points, bytes.data(), colors); },
        [&](auto& runs) { is_whole = unpack_runs(points, bytes, runs); },
        [&](auto& values) { copy(bytes, values); });
  });
  return is_whole;
}

}  // namespace fovea
