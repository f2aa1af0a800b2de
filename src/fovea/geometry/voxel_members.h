// Points sorted by the voxels that they lie in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/geometry/voxel_table.h"

namespace fovea {

class VoxelMembers {
 public:
  /// @param voxel_of_point  voxels' numbers, or VoxelTable::kNone
  /// @param voxels          how many there are
  VoxelMembers(std::span<const std::uint32_t> voxel_of_point, std::size_t voxels)
      : first_(voxels + 1, 0) {
    for (const std::uint32_t voxel : voxel_of_point) {
      if (voxel != VoxelTable::kNone) ++first_[voxel + 1];
    }
    for (std::size_t voxel = 0; voxel < voxels; ++voxel) first_[voxel + 1] += first_[voxel];
    members_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < voxel_of_point.size(); ++i) {
      if (voxel_of_point[i] != VoxelTable::kNone) members_[next[voxel_of_point[i]]++] = i;
    }
  }

  /// All points, voxel by voxel, and where those of a voxel begin among them.
  std::span<const std::uint32_t> all() const { return members_; }
  std::size_t first(std::size_t voxel) const { return first_[voxel]; }

  /// Indices of the points in a voxel, ascending.
  std::span<const std::uint32_t> of(std::size_t voxel) const {
    return std::span(members_).subspan(first_[voxel], first_[voxel + 1] - first_[voxel]);
  }

 private:
  std::vector<std::uint32_t> first_;  // of each voxel in members_
  std::vector<std::uint32_t> members_;
};

}  // namespace fovea
