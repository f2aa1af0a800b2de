#include "fovea/map/tile_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fovea/core/kept_rows.h"

namespace fovea {
namespace {

std::uint16_t range_steps(float range) {
  return steps<std::uint16_t>(double(range), double(kRangeStep));
}
std::uint8_t incidence_steps(float incidence) {
  if (std::isnan(incidence)) return TilePoints::kUnknownIncidence;
  return steps<std::uint8_t>(double(incidence), double(kIncidenceStep),
                             TilePoints::kUnknownIncidence - 1);
}

/// Calls `f(column_a, column_b)` for each column that tiles keep as runs and clouds as they are.
template <class A, class B, class F>
void for_each_run_column(A& a, B& b, F&& f) {
  f(a.camera, b.camera);
  f(a.frame, b.frame);
  f(a.interpolated, b.interpolated);
  f(a.reason, b.reason);
  f(a.intensity, b.intensity);
}

/// Bytes of the block in which an allocator puts so many: jemalloc's classes, four to a doubling.
std::size_t block_size(std::size_t bytes) {
  const std::size_t step = std::size_t{1}
                           << (std::bit_width(std::max<std::size_t>(bytes - 1, 64)) - 3);
  return (bytes + step - 1) / step * step;
}

/// Makes room for so many more values.
/// @return where to put them
template <class Value>
Value* grow(std::vector<Value>& column, std::size_t count) {
  const std::size_t before = column.size(), size = before + count;
  // What is in reserve takes memory, too: no more than the allocator would leave unused.
  if (column.capacity() < size) column.reserve(block_size(size * sizeof(Value)) / sizeof(Value));
  column.resize(size);
  return column.data() + before;
}

bool has_coarse(std::span<const std::uint8_t> levels) {
  return std::any_of(levels.begin(), levels.end(), [](std::uint8_t level) { return level > 0; });
}

}  // namespace

void TilePoints::check() const {
  const auto require = [&](const auto& column, bool may_be_empty = false) {
    if (column.size() == size() || (may_be_empty && column.empty())) return;
    throw std::logic_error(
        fmt::format("a column of a tile has {} entries for {} points", column.size(), size()));
  };
  for (const std::vector<std::uint16_t>& axis : position) require(axis);
  require(range);
  require(incidence);
  require(colors);
  for_each_run_column(*this, *this, [&](const auto& column, const auto&) {
    require(column, /*may_be_empty=*/static_cast<const void*>(&column) == &intensity);
  });
  for_each_default_column(*this, [&](const auto& column) { require(column, true); });
}

float TilePoints::incidence_at(std::size_t i) const {
  return incidence[i] == kUnknownIncidence ? std::numeric_limits<float>::quiet_NaN()
                                           : float(incidence[i]) * kIncidenceStep;
}

TilePoints TilePoints::of(const PointCloud& tile) {
  check_tile_columns(tile);
  TilePoints points;
  points.origin = tile.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    points.position[axis].reserve(tile.size());
    for (const Eigen::Vector3f& p : tile.position) {
      points.position[axis].push_back(position_steps(p[Eigen::Index(axis)]));
    }
  }
  points.range.reserve(tile.size());
  for (const float range : tile.range) points.range.push_back(range_steps(range));
  points.incidence.reserve(tile.size());
  for (const float incidence : tile.incidence) {
    points.incidence.push_back(incidence_steps(incidence));
  }
  points.colors.reserve(tile.size());
  for (std::size_t i = 0; i < tile.size(); ++i) points.colors.push_back(color_of(tile, i));
  for_each_run_column(points, tile, [](auto& to, const auto& from) { to.append(from); });
  if (has_coarse(tile.sampling_level)) points.sampling_level.append(tile.sampling_level);
  points.sensor.append(tile.sensor);
  points.widen_boxes(0);
  return points;
}

PointCloud TilePoints::cloud() const {
  PointCloud tile;
  tile.origin = origin;
  tile.position.reserve(size());
  tile.range.reserve(size());
  tile.incidence.reserve(size());
  tile.color.reserve(size());
  tile.views.reserve(size());
  tile.spread.reserve(size());
  tile.weight.reserve(size());
  tile.saturated.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) {
    tile.position.push_back(position_at(i));
    tile.range.push_back(range_at(i));
    tile.incidence.push_back(incidence_at(i));
    tile.color.push_back(colors[i].color);
    tile.views.push_back(colors[i].views);
    tile.spread.push_back(colors[i].spread);
    tile.weight.push_back(colors[i].weight);
    tile.saturated.push_back(colors[i].saturated);
  }
  for_each_run_column(tile, *this, [](auto& to, const auto& from) {
    to.resize(from.size());
    from.copy_to(to);
  });
  tile.sampling_level.resize(size());  // empty: 0
  sampling_level.copy_to(tile.sampling_level);
  tile.sensor.resize(sensor.size());
  sensor.copy_to(tile.sensor);
  return tile;
}

void TilePoints::append(const PointCloud& points, const TilePlaces& places,
                        std::span<const Range> ranges) {
  const std::size_t before = size();
  std::size_t count = 0;
  for (const auto& [begin, end] : ranges) count += end - begin;
  const auto append_each = [&](auto& column, auto&& value_of) {
    auto* to = grow(column, count);
    for (const auto& [begin, end] : ranges) {
      for (std::uint32_t i = begin; i < end; ++i) *to++ = value_of(i);
    }
  };
  append_each(range, [&](std::uint32_t i) { return range_steps(points.range[i]); });
  append_each(incidence, [&](std::uint32_t i) { return incidence_steps(points.incidence[i]); });
  append_each(colors, [&](std::uint32_t i) { return color_of(points, i); });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::uint16_t* at = grow(position[axis], count);
    for (const auto& [begin, end] : ranges) {
      at = std::copy(places[axis].begin() + begin, places[axis].begin() + end, at);
    }
  }
  for_each_run_column(*this, points, [&](auto& to, const auto& from) {
    if (from.empty()) return;
    for (const auto& [begin, end] : ranges) to.append(std::span(from).subspan(begin, end - begin));
  });
  if (!points.sampling_level.empty()) {
    const auto levels = [&](const Range& part) {
      return std::span(points.sampling_level).subspan(part.begin, part.end - part.begin);
    };
    const bool is_coarse = std::any_of(ranges.begin(), ranges.end(),
                                       [&](const Range& part) { return has_coarse(levels(part)); });
    if (is_coarse && sampling_level.empty() && before > 0) {
      sampling_level.push_back(0, std::uint32_t(before));
    }
    if (is_coarse || !sampling_level.empty()) {
      for (const Range& part : ranges) sampling_level.append(levels(part));
    }
  }
  if (!points.sensor.empty()) {
    if (sensor.empty()) sensor.push_back(0, std::uint32_t(before));
    for (const Range& part : ranges) {
      sensor.append(std::span(points.sensor).subspan(part.begin, part.end - part.begin));
    }
  }
  for_each_default_column(*this, [&](auto& column) {
    if (!column.empty() && column.size() < size()) column.push_back({}, std::uint32_t(count));
  });
  widen_boxes(before);
}

void TilePoints::widen_boxes(std::size_t first) {
  boxes.resize((size() + kBoxed - 1) / kBoxed);
  for (std::size_t block = first / kBoxed; block < boxes.size(); ++block) {
    Box& of_block = boxes[block];
    const std::size_t begin = std::max(first, block * kBoxed),
                      end = std::min(size(), (block + 1) * kBoxed);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::uint16_t low = of_block.low[axis], high = of_block.high[axis];
      for (std::size_t i = begin; i < end; ++i) {
        low = std::min(low, position[axis][i]);
        high = std::max(high, position[axis][i]);
      }
      of_block.low[axis] = low;
      of_block.high[axis] = high;
      box.low[axis] = std::min(box.low[axis], low);
      box.high[axis] = std::max(box.high[axis], high);
    }
  }
}

void TilePoints::keep(std::span<const std::uint32_t> indices) {
  const KeptRows kept(indices);
  for (std::vector<std::uint16_t>& axis : position) kept.close_up(axis);
  kept.close_up(range);
  kept.close_up(incidence);
  kept.close_up(colors);
  for_each_run_column(*this, *this, [&](auto& column, auto&) { column.keep(indices); });
  for_each_default_column(*this, [&](auto& column) { column.keep(indices); });
  box = {};
  boxes.clear();
  widen_boxes(0);
}

void check_tile_columns(const PointCloud& cloud) {
  cloud.check();
  if (cloud.empty()) return;
  const auto require = [](const char* name, const auto& column) {
    if (column.empty()) {
      throw std::logic_error(fmt::format("points of a map must have the column '{}'", name));
    }
  };
  require("range", cloud.range);
  require("incidence", cloud.incidence);
  require("color", cloud.color);
  require("frame", cloud.frame);
  require("camera", cloud.camera);
  require("interpolated", cloud.interpolated);
  require("views", cloud.views);
  require("spread", cloud.spread);
  require("weight", cloud.weight);
  require("reason", cloud.reason);
}

}  // namespace fovea
