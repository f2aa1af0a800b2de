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
  std::uint32_t find(const Voxel& voxel) const { return slots_[place_of(key_of(voxel))].id; }

  /// The voxel and its 26 neighbours.
  static std::array<Voxel, 27> block_around(const Voxel& center);

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t id = kNone;
  };
  static std::uint64_t key_of(const Voxel& voxel) {
    const auto axis = [](int value) { return static_cast<std::uint64_t>(value) & 0x1fffff; };
    return axis(voxel.x()) | axis(voxel.y()) << 21 | axis(voxel.z()) << 42;
  }
  /// Of the slot with this key, or of the free one where it belongs.
  std::size_t place_of(std::uint64_t key) const {
    // Fibonacci hashing (Knuth 6.4): the product's highest bits depend on all of the key's.
    std::size_t place = key * 0x9e3779b97f4a7c15ull >> shift_;
    while (slots_[place].key != key && slots_[place].id != kNone) {
      place = (place + 1) & (slots_.size() - 1);
    }
    return place;
  }
  void grow();

  float inverse_edge_;
  int shift_;                // 64 less the binary logarithm of the number of slots
  std::vector<Slot> slots_;  // a power of two of them, at most half in use
  std::vector<Voxel> voxels_;
};

}  // namespace fovea
