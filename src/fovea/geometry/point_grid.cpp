#include "fovea/geometry/point_grid.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace fovea {
namespace {

/// A cell is taken for this much nearer than computed, so that rounding loses nothing in it.
constexpr float kRounding = 0.9999f;

}  // namespace

PointGrid::PointGrid(std::span<const Eigen::Vector3f> points, float cell)
    : cell_(cell), table_(cell), index_(points.size()), position_(points.size()) {
  std::vector<std::uint32_t> cell_of_point(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cell_of_point[i] = table_.insert(table_.voxel_of(points[i]));
  }
  first_.assign(table_.size() + 1, 0);
  for (const std::uint32_t id : cell_of_point) ++first_[id + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint32_t place = next[cell_of_point[i]]++;
    index_[place] = i;
    position_[place] = points[i];
  }
}

void PointGrid::look_into(const VoxelTable::Voxel& cell, const Eigen::Vector3f& query,
                          Neighbor& best) const {
  const std::uint32_t id = table_.find(cell);
  if (id == VoxelTable::kNone) return;
  for (std::uint32_t k = first_[id], end = first_[id + 1]; k < end; ++k) {
    const float squared = (position_[k] - query).squaredNorm();
    if (squared > best.squared_distance) continue;
    if (squared < best.squared_distance || index_[k] < best.index) best = {index_[k], squared};
  }
}

Neighbor PointGrid::nearest(const Eigen::Vector3f& query, float max_distance) const {
  constexpr std::uint32_t kNobody = 0xffffffffu;
  // Whatever is at max_distance itself counts.
  Neighbor best{kNobody, max_distance * max_distance};
  const VoxelTable::Voxel own = table_.voxel_of(query);
  look_into(own, query, best);  // most often it is here, and little else is to be looked at
  const float reach = std::sqrt(best.squared_distance / kRounding);
  const VoxelTable::Voxel low = table_.voxel_of(query.array() - reach);
  const VoxelTable::Voxel high = table_.voxel_of(query.array() + reach);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const VoxelTable::Voxel cell(x, y, z);
        if (cell == own) continue;
        const Eigen::Array3f corner = cell.cast<float>().array() * cell_;
        const Eigen::Array3f gap =
            (corner - query.array()).max(query.array() - corner - cell_).max(0.0f);
        if (gap.matrix().squaredNorm() * kRounding > best.squared_distance) continue;
        look_into(cell, query, best);
      }
    }
  }
  if (best.index == kNobody) best.squared_distance = std::numeric_limits<float>::infinity();
  return best;
}

}  // namespace fovea
