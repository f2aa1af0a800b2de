#include "fovea/geometry/voxel_table.h"

#include <stdexcept>

namespace fovea {

VoxelTable::VoxelTable(float edge) : inverse_edge_(1 / edge) {
  if (!(edge > 0)) throw std::invalid_argument("the voxel edge must be positive");
}

std::uint32_t VoxelTable::insert(const Voxel& voxel) {
  const auto [brick, is_new] = number_of_brick_.try_emplace(
      cell_key(brick_of(voxel)), static_cast<std::uint32_t>(bricks_.size()));
  if (is_new) bricks_.emplace_back().fill(kNone);
  std::uint32_t& id = bricks_[*brick][place_in_brick(voxel)];
  if (id == kNone) {
    id = static_cast<std::uint32_t>(voxels_.size());
    voxels_.push_back(voxel);
  }
  return id;
}

std::array<VoxelTable::Voxel, 27> VoxelTable::block_around(const Voxel& center) {
  std::array<Voxel, 27> block;
  std::size_t i = 0;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) block[i++] = center + Voxel(x, y, z);
    }
  }
  return block;
}

}  // namespace fovea
