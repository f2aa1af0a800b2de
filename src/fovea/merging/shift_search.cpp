#include "fovea/merging/shift_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

using Eigen::Vector2i;

constexpr double kCell = 0.5;     // m
constexpr float kWallHeight = 1;  // m, of the points in a column
constexpr int kReach = int(kShiftReach / kCell);
constexpr double kLeastApart = 2;         // m
constexpr std::size_t kFewestWalls = 30;  // cells

/// Columns whose points extend over a wall's height.
std::vector<Vector2i> walls_of(std::span<const Eigen::Vector3f> points) {
  std::map<std::pair<int, int>, std::pair<float, float>> extents;
  for (const Eigen::Vector3f& p : points) {
    const std::pair cell(int(std::floor(p.x() / kCell)), int(std::floor(p.y() / kCell)));
    auto& [low, high] = extents.try_emplace(cell, p.z(), p.z()).first->second;
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  std::vector<Vector2i> walls;
  for (const auto& [cell, extent] : extents) {
    if (extent.second - extent.first >= kWallHeight) walls.emplace_back(cell.first, cell.second);
  }
  return walls;
}

/// Walls as a picture.
class WallGrid {
 public:
  explicit WallGrid(const std::vector<Vector2i>& walls) {
    Vector2i last = first_ = walls.front();
    for (const Vector2i& wall : walls) {
      first_ = first_.cwiseMin(wall);
      last = last.cwiseMax(wall);
    }
    size_ = last - first_ + Vector2i::Ones();
    cells_.resize(std::size_t(size_.x()) * std::size_t(size_.y()));
    for (const Vector2i& wall : walls) cells_[place(wall - first_)] = 1;
  }
  int at(const Vector2i& cell) const {
    const Vector2i in = cell - first_;
    if ((in.array() < 0).any() || (in.array() >= size_.array()).any()) return 0;
    return cells_[place(in)];
  }

 private:
  std::size_t place(const Vector2i& in) const {
    return std::size_t(in.y()) * std::size_t(size_.x()) + std::size_t(in.x());
  }
  Vector2i first_, size_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace

std::vector<Eigen::Vector2d> likely_shifts(std::span<const Eigen::Vector3f> points_a,
                                           std::span<const Eigen::Vector3f> points_b,
                                           std::size_t most) {
  const std::vector<Vector2i> walls_a = walls_of(points_a), walls_b = walls_of(points_b);
  if (std::min(walls_a.size(), walls_b.size()) < kFewestWalls) return {};
  const WallGrid grid_a(walls_a);
  struct Shift {
    int common = 0;
    Vector2i cells;
  };
  constexpr std::size_t kSide = 2 * kReach + 1;
  std::vector<Shift> shifts(kSide * kSide);
  parallel_for(kSide, 8, [&](std::size_t row) {
    for (std::size_t column = 0; column < kSide; ++column) {
      Shift& shift = shifts[row * kSide + column];
      shift.cells = Vector2i(int(column) - kReach, int(row) - kReach);
      for (const Vector2i& wall : walls_b) shift.common += grid_a.at(wall + shift.cells);
    }
  });
  std::stable_sort(shifts.begin(), shifts.end(),
                   [](const Shift& x, const Shift& y) { return x.common > y.common; });
  std::vector<Eigen::Vector2d> likely;
  for (const Shift& shift : shifts) {
    if (likely.size() == most) break;
    const Eigen::Vector2d place = kCell * shift.cells.cast<double>();
    const bool is_new = std::all_of(likely.begin(), likely.end(), [&](const auto& other) {
      return (other - place).norm() >= kLeastApart;
    });
    if (is_new) likely.push_back(place);
  }
  return likely;
}

}  // namespace fovea
