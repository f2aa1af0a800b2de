#include "fovea/mapping/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fovea/core/parallel.h"
#include "fovea/core/quick_angle.h"
#include "fovea/core/steps.h"

namespace fovea {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kColumns = 720;      // half a degree
constexpr float kMinRange = 0.5f;  // m; nearer returns are on the vehicle or invalid
/// Ranges are stored in steps, in half the memory of floats.
constexpr float kStep = 0.005f;             // m
constexpr std::uint16_t kFarthest = 65534;  // or beyond
constexpr std::uint16_t kNothing = 65535;

/// Columns to either side that a ball of about 0.15 m covers, from each range on.
struct Window {
  float range;  // m
  int half_width;
};
constexpr std::array<Window, 3> kWindows{{{12, 1}, {6, 2}, {0, 4}}};
/// Least share of a window's cells with a return that free space requires.
constexpr float kFilledShare = 0.4f;

float column_of(float x, float y) {  // with a fraction
  return (quick_atan2(y, x) + kPi) * (kColumns / (2 * kPi));
}
float row_of(float z, float flat, float row_height) {
  return std::floor(quick_atan2(z, flat) / row_height);
}
int whole_column(float column) { return std::clamp(static_cast<int>(column), 0, kColumns - 1); }

struct Return {
  std::int16_t row, column;
  std::uint16_t range;  // steps
};

/// Directions and ranges of a block of points: one array for each value, so that loops vectorize.
struct DirectionBlock {
  static constexpr std::size_t kSize = 256;
  using Row = std::array<float, kSize>;
  alignas(64) Row x{}, y{}, z{}, flat{}, range{}, row{}, column{};

  void compute(std::span<const Eigen::Vector3f> points, float row_height) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      x[i] = points[i].x();
      y[i] = points[i].y();
      z[i] = points[i].z();
    }
    for (std::size_t i = 0; i < kSize; ++i) {
      const float flat2 = x[i] * x[i] + y[i] * y[i];
      flat[i] = std::sqrt(flat2);
      range[i] = std::sqrt(flat2 + z[i] * z[i]);
    }
    for (std::size_t i = 0; i < kSize; ++i) row[i] = row_of(z[i], flat[i], row_height);
    for (std::size_t i = 0; i < kSize; ++i) column[i] = column_of(x[i], y[i]);
  }
};

/// All finite returns beyond kMinRange, by chunks.
std::vector<std::vector<Return>> returns_of(std::span<const Eigen::Vector3f> scan_lidar,
                                            float row_height) {
  constexpr std::size_t kGrain = 32 * DirectionBlock::kSize;
  std::vector<std::vector<Return>> chunks((scan_lidar.size() + kGrain - 1) / kGrain);
  parallel_chunks(scan_lidar.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    DirectionBlock block;
    std::vector<Return>& returns = chunks[begin / kGrain];
    returns.reserve(end - begin);
    for (; begin < end; begin += DirectionBlock::kSize) {
      const std::size_t count = std::min(DirectionBlock::kSize, end - begin);
      block.compute(scan_lidar.subspan(begin, count), row_height);
      for (std::size_t i = 0; i < count; ++i) {
        if (!(block.range[i] > kMinRange) || !std::isfinite(block.range[i])) continue;
        returns.push_back({static_cast<std::int16_t>(block.row[i]),
                           static_cast<std::int16_t>(whole_column(block.column[i])),
                           steps(block.range[i], kStep, kFarthest)});
      }
    }
  });
  return chunks;
}

}  // namespace

RangeImage::RangeImage(std::span<const Eigen::Vector3f> scan_lidar, double row_height)
    : row_height_(static_cast<float>(row_height)) {
  const std::vector<std::vector<Return>> returns = returns_of(scan_lidar, row_height_);
  int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
  for (const std::vector<Return>& chunk : returns) {
    for (const Return& r : chunk) {
      lowest = std::min(lowest, int{r.row});
      highest = std::max(highest, int{r.row});
    }
  }
  if (lowest > highest) return;
  first_row_ = lowest;
  rows_ = highest - lowest + 1;

  Level cells;
  cells.nearest.assign(static_cast<std::size_t>(rows_) * kColumns, kNothing);
  for (const std::vector<Return>& chunk : returns) {
    for (const Return& r : chunk) {
      std::uint16_t& nearest =
          cells.nearest[static_cast<std::size_t>(r.row - first_row_) * kColumns + r.column];
      nearest = std::min(nearest, r.range);
    }
  }
  cells.filled.resize(cells.nearest.size());
  for (std::size_t i = 0; i < cells.filled.size(); ++i)
    cells.filled[i] = cells.nearest[i] < kNothing;
  parallel_for(kLevels, 1,
               [&](std::size_t k) { levels_[k] = widen(cells, kWindows[k].half_width); });
}

int RangeImage::half_height(int half_width) const {
  const double rows = half_width * kLeastRowHeight / double(row_height_);
  return std::max(1, static_cast<int>(std::lround(rows)));
}

void RangeImage::merge(const Level& from, std::size_t from_cell, Level& to, std::size_t to_cell,
                       std::size_t count) {
  const std::uint16_t* const nearest = from.nearest.data() + from_cell;
  const std::uint8_t* const filled = from.filled.data() + from_cell;
  std::uint16_t* const to_nearest = to.nearest.data() + to_cell;
  std::uint8_t* const to_filled = to.filled.data() + to_cell;
  for (std::size_t i = 0; i < count; ++i) to_nearest[i] = std::min(to_nearest[i], nearest[i]);
  for (std::size_t i = 0; i < count; ++i) {
    to_filled[i] = static_cast<std::uint8_t>(to_filled[i] + filled[i]);
  }
}

RangeImage::Level RangeImage::widen(const Level& cells, int half) const {
  const int half_rows = half_height(half);
  // Along rows, which are closed rings, then along columns.
  Level wide = cells;
  for (int row = 0; row < rows_; ++row) {
    const std::size_t begin = static_cast<std::size_t>(row) * kColumns;
    for (int k = -half; k <= half; ++k) {
      if (k == 0) continue;
      // Two runs of cells instead of a remainder for each cell.
      const auto shift = static_cast<std::size_t>((k + kColumns) % kColumns);
      merge(cells, begin + shift, wide, begin, kColumns - shift);
      merge(cells, begin, wide, begin + kColumns - shift, shift);
    }
  }
  Level result = wide;
  for (int row = 0; row < rows_; ++row) {
    for (int k = std::max(0, row - half_rows); k <= std::min(rows_ - 1, row + half_rows); ++k) {
      if (k == row) continue;
      merge(wide, static_cast<std::size_t>(k) * kColumns, result,
            static_cast<std::size_t>(row) * kColumns, kColumns);
    }
  }
  return result;
}

Visibility RangeImage::visibility(const Eigen::Vector3f& p) const {
  return visibility_at(p.norm(), row_of(p.z(), p.head<2>().norm(), row_height_),
                       column_of(p.x(), p.y()));
}

void RangeImage::classify(std::span<const Eigen::Vector3f> p_lidar,
                          std::span<Visibility> visibilities) const {
  DirectionBlock block;
  for (std::size_t begin = 0; begin < p_lidar.size(); begin += DirectionBlock::kSize) {
    const std::size_t count = std::min(DirectionBlock::kSize, p_lidar.size() - begin);
    block.compute(p_lidar.subspan(begin, count), row_height_);
    for (std::size_t i = 0; i < count; ++i) {
      visibilities[begin + i] = visibility_at(block.range[i], block.row[i], block.column[i]);
    }
  }
}

Visibility RangeImage::visibility_at(float range, float row_of_position,
                                     float column_of_position) const {
  if (!(range > kMinRange)) return Visibility::kUnknown;
  const auto window =
      static_cast<std::size_t>(std::find_if(kWindows.begin(), kWindows.end(),
                                            [&](const Window& w) { return range >= w.range; }) -
                               kWindows.begin());
  const int half = kWindows[window].half_width;
  const int row = static_cast<int>(row_of_position) - first_row_;
  if (row < 0 || row >= rows_) return Visibility::kUnknown;
  const std::size_t cell =
      static_cast<std::size_t>(row) * kColumns + whole_column(column_of_position);
  const std::uint16_t range_steps = levels_[window].nearest[cell];
  const float nearest =
      range_steps == kNothing ? std::numeric_limits<float>::infinity() : float(range_steps) * kStep;
  if (nearest < range - kMargin) return Visibility::kUnknown;  // something is in front of it
  if (nearest <= range + kMargin) return Visibility::kSurface;
  const int half_rows = half_height(half);
  const bool above_and_below = row >= half_rows && row + half_rows < rows_;
  const auto cells = static_cast<float>((2 * half + 1) * (2 * half_rows + 1));
  const bool enough = levels_[window].filled[cell] >= kFilledShare * cells;
  return above_and_below && enough ? Visibility::kFree : Visibility::kUnknown;
}

}  // namespace fovea
