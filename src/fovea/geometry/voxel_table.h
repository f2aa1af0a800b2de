// A sparse grid of voxels, each with a number of its own in the order of its first appearance.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace fovea {

/// Hash table from voxels to numbers 0, 1, 2, ...; open addressing, because it is asked once for
/// every point of a map, and of bricks of 4 x 4 x 4 voxels, because who asks for a voxel asks for
/// its neighbours next: they are in the cache. Holds coordinates within +-4 million voxels.
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
    const std::uint32_t brick = slots_[place_of(brick_key(voxel))].brick;
    return brick == kNone ? kNone : bricks_[brick][place_in_brick(voxel)];
  }

  /// The voxel and its 26 neighbours.
  static std::array<Voxel, 27> block_around(const Voxel& center);

 private:
  static constexpr int kBits = 2;  // of a coordinate, in its brick
  using Brick = std::array<std::uint32_t, 1 << 3 * kBits>;
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t brick = kNone;
  };
  static std::uint64_t brick_key(const Voxel& voxel) {
    const auto axis = [](int value) {
      return static_cast<std::uint64_t>(value >> kBits) & 0x1fffff;
    };
    return axis(voxel.x()) | axis(voxel.y()) << 21 | axis(voxel.z()) << 42;
  }
  static std::size_t place_in_brick(const Voxel& voxel) {
    const auto axis = [](int value) {
      return static_cast<std::size_t>(value) & ((std::size_t{1} << kBits) - 1);
    };
    return axis(voxel.x()) | axis(voxel.y()) << kBits | axis(voxel.z()) << 2 * kBits;
  }
  /// Of the slot with this key, or of the free one where it belongs.
  std::size_t place_of(std::uint64_t key) const {
    // Fibonacci hashing (Knuth 6.4): the product's highest bits depend on all of the key's.
    std::size_t place = key * 0x9e3779b97f4a7c15ull >> shift_;
    while (slots_[place].key != key && slots_[place].brick != kNone) {
      place = (place + 1) & (slots_.size() - 1);
    }
    return place;
  }
  void grow();

  float inverse_edge_;
  int shift_;                // 64 less the binary logarithm of the number of slots
  std::vector<Slot> slots_;  // a power of two of them, at most half in use
  std::vector<Brick> bricks_;
  std::vector<Voxel> voxels_;
};

}  // namespace fovea
