#include "fovea/geometry/voxel_table.h"

#include <stdexcept>

namespace fovea {
namespace {

constexpr int kFirstBits = 10;

}  // namespace

VoxelTable::VoxelTable(float edge)
    : inverse_edge_(1 / edge), shift_(64 - kFirstBits), slots_(std::size_t{1} << kFirstBits) {
  if (!(edge > 0)) throw std::invalid_argument("the voxel edge must be positive");
}

std::uint32_t VoxelTable::insert(const Voxel& voxel) {
  const std::uint64_t key = brick_key(voxel);
  Slot& slot = slots_[place_of(key)];
  std::uint32_t brick = slot.brick;
  if (brick == kNone) {
    brick = static_cast<std::uint32_t>(bricks_.size());
    slot = {key, brick};
    bricks_.emplace_back().fill(kNone);
    if (2 * bricks_.size() > slots_.size()) grow();
  }
  std::uint32_t& id = bricks_[brick][place_in_brick(voxel)];
  if (id == kNone) {
    id = static_cast<std::uint32_t>(voxels_.size());
    voxels_.push_back(voxel);
  }
  return id;
}

void VoxelTable::grow() {
  std::vector<Slot> before(2 * slots_.size());
  before.swap(slots_);
  --shift_;
  for (const Slot& slot : before) {
    if (slot.brick != kNone) slots_[place_of(slot.key)] = slot;
  }
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
