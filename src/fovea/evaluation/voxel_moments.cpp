#include "fovea/evaluation/voxel_moments.h"

namespace fovea {

VoxelMoments::VoxelMoments(const std::vector<Eigen::Vector3f>& points, float edge) : table_(edge) {
  for (const Eigen::Vector3f& point : points) {
    const std::uint32_t voxel = table_.insert(table_.voxel_of(point));
    if (voxel == moments_.size()) moments_.emplace_back();
    moments_[voxel].add(point.cast<double>());
  }
}

Moments VoxelMoments::around(std::size_t voxel) const {
  Moments total;
  table_.for_each_around(table_.voxel(static_cast<std::uint32_t>(voxel)),
                         [&](std::uint32_t near) { total.add(moments_[near]); });
  return total;
}

}  // namespace fovea
