#include "fovea/mapping/moving/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fovea {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kColumns = 720;                   // half a degree
constexpr float kRowHeight = 0.6f * kPi / 180;  // more than the spacing of a spinning LiDAR's rings
constexpr float kMinRange = 0.5f;               // m; nearer is the vehicle, or no return at all
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Cells to either side that a ball of about 0.15 m covers, from each range on.
struct Window {
  float range;  // m
  int half_width;
};
constexpr std::array<Window, 3> kWindows{{{12, 1}, {6, 2}, {0, 4}}};
/// Share of a window's cells that must hold a return for its silence to mean anything.
constexpr float kFilledShare = 0.4f;

int column_of(float x, float y) {
  const int column = static_cast<int>((std::atan2(y, x) + kPi) * (kColumns / (2 * kPi)));
  return std::clamp(column, 0, kColumns - 1);
}
int row_of(float z, float range) {
  return static_cast<int>(std::floor(std::asin(std::clamp(z / range, -1.0f, 1.0f)) / kRowHeight));
}

}  // namespace

RangeImage::RangeImage(std::span<const Eigen::Vector3f> scan_lidar) {
  struct Return {
    int row, column;
    float range;
  };
  std::vector<Return> returns;
  returns.reserve(scan_lidar.size());
  int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
  for (const Eigen::Vector3f& p : scan_lidar) {
    const float range = p.norm();
    if (!(range > kMinRange) || !std::isfinite(range)) continue;
    const int row = row_of(p.z(), range);
    lowest = std::min(lowest, row);
    highest = std::max(highest, row);
    returns.push_back({row, column_of(p.x(), p.y()), range});
  }
  if (returns.empty()) return;
  first_row_ = lowest;
  rows_ = highest - lowest + 1;

  Level cells;
  cells.nearest.assign(static_cast<std::size_t>(rows_) * kColumns, kNothing);
  for (const Return& r : returns) {
    float& nearest = cells.nearest[static_cast<std::size_t>(r.row - lowest) * kColumns + r.column];
    nearest = std::min(nearest, r.range);
  }
  cells.filled.resize(cells.nearest.size());
  for (std::size_t i = 0; i < cells.filled.size(); ++i)
    cells.filled[i] = cells.nearest[i] < kNothing;
  for (std::size_t k = 0; k < kLevels; ++k) levels_[k] = widened(cells, kWindows[k].half_width);
}

RangeImage::Level RangeImage::widened(const Level& cells, int half) const {
  // Along rows, which close to a ring, and then along columns.
  Level wide = cells;
  for (int row = 0; row < rows_; ++row) {
    const std::size_t begin = static_cast<std::size_t>(row) * kColumns;
    for (int column = 0; column < kColumns; ++column) {
      float nearest = kNothing;
      int filled = 0;
      for (int k = -half; k <= half; ++k) {
        const std::size_t i = begin + static_cast<std::size_t>((column + k + kColumns) % kColumns);
        nearest = std::min(nearest, cells.nearest[i]);
        filled += cells.filled[i];
      }
      wide.nearest[begin + column] = nearest;
      wide.filled[begin + column] = static_cast<std::uint8_t>(filled);
    }
  }
  Level result = wide;
  for (int row = 0; row < rows_; ++row) {
    for (int k = std::max(0, row - half); k <= std::min(rows_ - 1, row + half); ++k) {
      if (k == row) continue;
      for (int column = 0; column < kColumns; ++column) {
        const std::size_t to = static_cast<std::size_t>(row) * kColumns + column;
        const std::size_t from = static_cast<std::size_t>(k) * kColumns + column;
        result.nearest[to] = std::min(result.nearest[to], wide.nearest[from]);
        result.filled[to] = static_cast<std::uint8_t>(result.filled[to] + wide.filled[from]);
      }
    }
  }
  return result;
}

Sight RangeImage::sight(const Eigen::Vector3f& p) const {
  const float range = p.norm();
  if (!(range > kMinRange)) return Sight::kUnknown;
  const auto window =
      static_cast<std::size_t>(std::find_if(kWindows.begin(), kWindows.end(),
                                            [&](const Window& w) { return range >= w.range; }) -
                               kWindows.begin());
  const int half = kWindows[window].half_width;
  const int row = row_of(p.z(), range) - first_row_;
  if (row < 0 || row >= rows_) return Sight::kUnknown;
  const std::size_t cell = static_cast<std::size_t>(row) * kColumns + column_of(p.x(), p.y());
  const float nearest = levels_[window].nearest[cell];
  if (nearest < range - kMargin) return Sight::kUnknown;  // something stands before it
  if (nearest <= range + kMargin) return Sight::kSurface;
  const bool above_and_below = row >= half && row + half < rows_;
  const auto width = static_cast<float>(2 * half + 1);
  const bool enough = levels_[window].filled[cell] >= kFilledShare * width * width;
  return above_and_below && enough ? Sight::kFree : Sight::kUnknown;
}

}  // namespace fovea
