#include "fovea/evaluation/voxel_moments.h"

namespace fovea {

VoxelMoments::VoxelMoments(const std::vector<Eigen::Vector3f>& points, float edge) : table_(edge) {
  voxel_of_point_.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    voxel_of_point_.push_back(table_.insert(table_.voxel_of(point)));
    if (voxel_of_point_.back() == moments_.size()) moments_.emplace_back();
    moments_[voxel_of_point_.back()].add(point.cast<double>());
  }
}

Moments VoxelMoments::around(std::size_t voxel) const {
  Moments total;
  for (const VoxelTable::Voxel& near :
       VoxelTable::block_around(table_.voxel(static_cast<std::uint32_t>(voxel)))) {
    const std::uint32_t neighbor = table_.find(near);
    if (neighbor != VoxelTable::kNone) total.add(moments_[neighbor]);
  }
  return total;
}

}  // namespace fovea
