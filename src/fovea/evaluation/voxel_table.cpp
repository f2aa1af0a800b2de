#include "fovea/evaluation/voxel_table.h"

#include <stdexcept>

#include "fovea/base/random.h"

namespace fovea {
namespace {

constexpr std::size_t kFirstSlots = 1 << 10;

std::uint64_t hash_of(const VoxelTable::Voxel& v) {
  const auto axis = [](int value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value) + (1 << 20)) & 0x1fffff;
  };
  return Random(axis(v.x()) | axis(v.y()) << 21 | axis(v.z()) << 42).next();
}

}  // namespace

VoxelTable::VoxelTable(float edge) : inverse_edge_(1 / edge), slots_(kFirstSlots, kNone) {
  if (!(edge > 0)) throw std::invalid_argument("the voxel edge must be positive");
}

std::size_t VoxelTable::slot_of(const Voxel& voxel) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(voxel) & mask;
  while (slots_[slot] != kNone && voxels_[slots_[slot]] != voxel) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t VoxelTable::insert(const Voxel& voxel) {
  const std::size_t slot = slot_of(voxel);
  if (slots_[slot] != kNone) return slots_[slot];
  const auto id = static_cast<std::uint32_t>(voxels_.size());
  slots_[slot] = id;
  voxels_.push_back(voxel);
  if (2 * voxels_.size() > slots_.size()) grow();
  return id;
}

void VoxelTable::grow() {
  slots_.assign(2 * slots_.size(), kNone);
  for (std::uint32_t id = 0; id < voxels_.size(); ++id) slots_[slot_of(voxels_[id])] = id;
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
