#include "fovea/exporting/views/point_thinner.h"

#include <cmath>
#include <utility>

namespace fovea {
namespace {

constexpr double kGrowth = 1.25;

}  // namespace

std::uint64_t PointThinner::key_of(const Eigen::Vector3d& position) const {
  constexpr int kBits = 21;  // cells farther apart than 2^21 may have the same key
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(position[axis] / cell_));
    key = key << kBits | (static_cast<std::uint64_t>(cell) & ((std::uint64_t{1} << kBits) - 1));
  }
  return key;
}

void PointThinner::add(const Point& point) {
  if (!taken_.try_emplace(key_of(point.position)).second) return;
  points_.push_back(point);
  while (points_.size() > max_points_) grow_cells();
}

void PointThinner::grow_cells() {
  cell_ *= kGrowth;
  taken_ = {};
  std::vector<Point> points;
  std::swap(points, points_);
  for (const Point& point : points) {
    if (taken_.try_emplace(key_of(point.position)).second) points_.push_back(point);
  }
}

}  // namespace fovea
