// A sparse grid of voxels, each with a number of its own in the order of its first appearance.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace fovea {

/// Hash table from voxels to numbers 0, 1, 2, ...; open addressing, because it is asked once for
/// every point of a map. Holds coordinates within +-1 million voxels.
class VoxelTable {
 public:
  using Voxel = Eigen::Vector3i;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// @param edge  of a voxel, m
  explicit VoxelTable(float edge);

  Voxel voxel_of(const Eigen::Vector3f& p) const {
    return (p * inverse_edge_).array().floor().cast<int>();
  }
  std::size_t size() const { return voxels_.size(); }
  /// The voxel of a number.
  const Voxel& voxel(std::uint32_t id) const { return voxels_[id]; }

  /// Number of a voxel, a new one where it had none.
  std::uint32_t insert(const Voxel& voxel);
  /// Number of a voxel, or kNone. Thread-safe while nothing is inserted.
  std::uint32_t find(const Voxel& voxel) const { return slots_[slot_of(voxel)]; }

  /// The voxel and its 26 neighbours.
  static std::array<Voxel, 27> block_around(const Voxel& center);

 private:
  std::size_t slot_of(const Voxel& voxel) const;
  void grow();

  float inverse_edge_;
  std::vector<std::uint32_t> slots_;  // a power of two of them, at most half in use
  std::vector<Voxel> voxels_;
};

}  // namespace fovea
