// A sparse grid of voxels, numbered in the order of their first appearance.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fovea/core/flat_map.h"
#include "fovea/geometry/cell_brick.h"

namespace fovea {

/// Maps voxels to numbers 0, 1, 2, ... The hash table holds bricks of 4 x 4 x 4 voxels: searches
/// for neighboring voxels follow each other and find their brick in the cache. Coordinates are
/// within
/// +-4 million voxels.
class VoxelTable {
 public:
  using Voxel = Eigen::Vector3i;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// @param edge  of a voxel (m)
  explicit VoxelTable(float edge);

  Voxel voxel_of(const Eigen::Vector3f& p) const {
    return (p * inverse_edge_).array().floor().cast<int>();
  }
  std::size_t size() const { return voxels_.size(); }
  /// The voxel with a number.
  const Voxel& voxel(std::uint32_t id) const { return voxels_[id]; }

  /// Number of a voxel; a new number if the voxel has none.
  std::uint32_t insert(const Voxel& voxel);
  /// Number of a voxel, or kNone. Thread-safe while nothing is inserted.
  std::uint32_t find(const Voxel& voxel) const {
    const Brick* brick = find_brick(brick_of(voxel));
    return brick == nullptr ? kNone : (*brick)[place_in_brick(voxel)];
  }

  /// The voxel and its 26 neighbors.
  static std::array<Voxel, 27> block_around(const Voxel& center);

  /// Calls f(number) for those of the 27 voxels that have a number, in the same order. Thread-safe
  /// while nothing is inserted.
  template <class F>
  void for_each_around(const Voxel& center, F&& f) const {
    // They lie in at most two bricks along each axis. Each brick is searched once.
    const Voxel low = brick_of(center.array() - 1), high = brick_of(center.array() + 1);
    std::array<const Brick*, 8> bricks{};
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) {
          const Voxel brick(x, y, z);
          bricks[place_among(brick - low)] = find_brick(brick);
        }
      }
    }
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const Voxel voxel = center + Voxel(x, y, z);
          const Brick* brick = bricks[place_among(brick_of(voxel) - low)];
          if (brick == nullptr) continue;
          const std::uint32_t id = (*brick)[place_in_brick(voxel)];
          if (id != kNone) f(id);
        }
      }
    }
  }

 private:
  static constexpr int kBits = 2;  // of a coordinate within its brick
  using Brick = std::array<std::uint32_t, 1 << 3 * kBits>;
  static Voxel brick_of(const Voxel& voxel) {
    return voxel.unaryExpr([](int i) { return i >> kBits; });
  }
  const Brick* find_brick(const Voxel& brick) const {
    const std::uint32_t* number = number_of_brick_.find(cell_key(brick));
    return number == nullptr ? nullptr : &bricks_[*number];
  }
  /// Place of a brick among two along each axis.
  static std::size_t place_among(const Voxel& step) {
    return static_cast<std::size_t>(step.x() | step.y() << 1 | step.z() << 2);
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
