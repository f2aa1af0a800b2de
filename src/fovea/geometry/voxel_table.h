// A sparse grid of voxels, each with a number of its own in the order of its first appearance.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fovea/base/flat_map.h"
#include "fovea/geometry/cell_brick.h"

namespace fovea {

/// Hash table from voxels to numbers 0, 1, 2, ...; of bricks of 4 x 4 x 4 voxels, because who asks
/// for a voxel asks for its neighbours next: they are in the cache. Holds coordinates within +-4
/// million voxels.
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
  std::uint32_t find(const Voxel& voxel) const {
    const std::uint32_t* brick = number_of_brick_.find(brick_key(voxel));
    return brick == nullptr ? kNone : bricks_[*brick][place_in_brick(voxel)];
  }

  /// The voxel and its 26 neighbours.
  static std::array<Voxel, 27> block_around(const Voxel& center);

 private:
  static constexpr int kBits = 2;  // of a coordinate, in its brick
  using Brick = std::array<std::uint32_t, 1 << 3 * kBits>;
  static std::uint64_t brick_key(const Voxel& voxel) {
    return cell_key(voxel.array().unaryExpr([](int i) { return i >> kBits; }));
  }
  static std::size_t place_in_brick(const Voxel& voxel) {
    const auto axis = [](int value) {
      return static_cast<std::size_t>(value) & ((std::size_t{1} << kBits) - 1);
    };
    return axis(voxel.x()) | axis(voxel.y()) << kBits | axis(voxel.z()) << 2 * kBits;
  }

  float inverse_edge_;
  FlatMap<std::uint32_t> number_of_brick_;
  std::vector<Brick> bricks_;
  std::vector<Voxel> voxels_;
};

}  // namespace fovea
