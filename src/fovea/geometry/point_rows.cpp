#include "fovea/geometry/point_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "fovea/core/radix_sort.h"

namespace fovea {
namespace {

constexpr float kFarthest = 1 << 20;  // cells: three numbers of 21 bits are a key

struct Extent {
  std::int32_t low = 0, high = 0;
  explicit Extent(const std::vector<std::int32_t>& cells) {
    if (cells.empty()) return;
    const auto [least, most] = std::minmax_element(cells.begin(), cells.end());
    low = *least;
    high = *most;
  }
  int bits() const { return std::bit_width(static_cast<std::uint32_t>(high - low)); }
};

struct Place {  // of a row
  std::int32_t z, y;
};
bool is_before(const PointRows::Row& row, const Place& place) {
  return std::tie(row.z, row.y) < std::tie(place.z, place.y);
}

}  // namespace

PointRows::PointRows(std::span<const Eigen::Vector3f> points, float edge) : edge_(edge) {
  if (!(edge > 0)) throw std::invalid_argument("the edge of a cell must be positive");
  const float per_metre = 1 / edge;
  std::array<std::vector<std::int32_t>, 3> cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cell[axis].resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      cell[axis][i] = static_cast<std::int32_t>(std::clamp(
          std::floor(points[i][Eigen::Index(axis)] * per_metre), -kFarthest, kFarthest - 1));
    }
  }
  const bool is_short =
      Extent(cell[0]).bits() + Extent(cell[1]).bits() + Extent(cell[2]).bits() <= 32;
  is_short ? sort<std::uint32_t>(points, cell) : sort<std::uint64_t>(points, cell);
}

template <class Key>
void PointRows::sort(std::span<const Eigen::Vector3f> points,
                     const std::array<std::vector<std::int32_t>, 3>& cell) {
  const Extent x(cell[0]), y(cell[1]), z(cell[2]);
  struct Keyed {
    Key key;
    std::uint32_t point;
  };
  std::vector<Keyed> keyed(points.size());
  for (std::uint32_t i = 0; i < keyed.size(); ++i) {
    const auto from = [&](std::size_t axis, const Extent& extent) {
      return static_cast<Key>(cell[axis][i] - extent.low);
    };
    keyed[i] = {((from(2, z) << y.bits() | from(1, y)) << x.bits()) | from(0, x), i};
  }
  radix_sort(keyed, x.bits() + y.bits() + z.bits());

  order_.resize(points.size());
  for (std::vector<float>& row : coordinates_) row.resize(points.size() + kLanes);
  for (std::uint32_t place = 0; place < keyed.size(); ++place) {
    const std::uint32_t point = keyed[place].point;
    const Key key = keyed[place].key;
    if (place == 0 || key != keyed[place - 1].key) {
      if (place == 0 || key >> x.bits() != keyed[place - 1].key >> x.bits()) {
        rows_.push_back(
            {cell[1][point], cell[2][point], static_cast<std::uint32_t>(cells_.size())});
      }
      cells_.push_back({cell[0][point], place});
    }
    order_[place] = point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      coordinates_[axis][place] = points[point][Eigen::Index(axis)];
    }
  }
  rows_.push_back({0, 0, static_cast<std::uint32_t>(cells_.size())});
  cells_.push_back({0, static_cast<std::uint32_t>(points.size())});
}

RowSurroundings::RowSurroundings(const PointRows& points, int reach, std::size_t first_row)
    : points_(points), reach_(reach), layer_(2 * static_cast<std::size_t>(reach) + 1) {
  const auto rows = points.rows().first(points.size());
  if (first_row >= rows.size()) return;
  for (std::size_t k = 0; k < layer_.size(); ++k) {
    const Place first{rows[first_row].z - reach + static_cast<std::int32_t>(k),
                      rows[first_row].y - reach};
    layer_[k] = static_cast<std::size_t>(
        std::lower_bound(rows.begin(), rows.end(), first, is_before) - rows.begin());
  }
}

void RowSurroundings::begin_row(std::size_t row) {
  const std::span<const PointRows::Row> rows = points_.rows();
  const std::size_t count = points_.size();
  strips_.clear();
  for (std::size_t k = 0; k < layer_.size(); ++k) {
    const Place first{rows[row].z - reach_ + static_cast<std::int32_t>(k), rows[row].y - reach_};
    const std::int32_t last_y = rows[row].y + reach_;
    std::size_t& next = layer_[k];
    while (next < count && is_before(rows[next], first)) ++next;
    for (std::size_t r = next; r < count && rows[r].z == first.z && rows[r].y <= last_y; ++r) {
      strips_.push_back({rows[r].first_cell, rows[r].first_cell, rows[r + 1].first_cell});
    }
  }
}

void RowSurroundings::move_to(std::int32_t x) {
  const std::span<const PointRows::Cell> cells = points_.cells();
  ranges_.clear();
  size_ = 0;
  for (Strip& strip : strips_) {
    while (strip.begin < strip.row_end && cells[strip.begin].x < x - reach_) ++strip.begin;
    strip.end = std::max(strip.end, strip.begin);
    while (strip.end < strip.row_end && cells[strip.end].x <= x + reach_) ++strip.end;
    if (strip.begin == strip.end) continue;
    ranges_.push_back({cells[strip.begin].first_point, cells[strip.end].first_point});
    size_ += ranges_.back().end - ranges_.back().begin;
  }
}

}  // namespace fovea
