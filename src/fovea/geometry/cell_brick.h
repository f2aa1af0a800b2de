// Sets of cells of a fine grid, for surfaces: a piece of surface fills some cells, space none.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace fovea {

/// A number for a cell of a grid, each coordinate within 2^20.
inline std::uint64_t cell_key(const Eigen::Array3i& cell) {
  std::uint64_t key = 0;
  for (const int i : cell) key = key << 21 | (static_cast<std::uint64_t>(i) & 0x1fffff);
  return key;
}

/// 8 x 8 x 8 cells, one bit each.
class CellBrick {
 public:
  static constexpr int kEdge = 8;  ///< cells

  /// @param cell  in the brick, each coordinate 0-7
  bool test(const Eigen::Array3i& cell) const {
    return (layers_[static_cast<std::size_t>(cell.z())] >> bit(cell) & 1) != 0;
  }
  /// @return whether it was not marked before
  bool mark(const Eigen::Array3i& cell) {
    std::uint64_t& layer = layers_[static_cast<std::size_t>(cell.z())];
    const std::uint64_t before = layer;
    layer |= std::uint64_t{1} << bit(cell);
    return layer != before;
  }

 private:
  static int bit(const Eigen::Array3i& cell) { return cell.y() * kEdge + cell.x(); }
  std::array<std::uint64_t, kEdge> layers_{};
};

/// Any cells; fast where one is near the one before.
class CellSet {
 public:
  /// @param cell  each coordinate within 2^23
  /// @return whether it was not marked before
  bool mark(const Eigen::Array3i& cell) {
    const Eigen::Array3i brick = cell.unaryExpr([](int i) { return i >> 3; });
    const std::uint64_t key = cell_key(brick);
    if (bricks_.empty() || key != last_key_) {
      last_ = place_of(key);
      last_key_ = key;
    }
    return bricks_[last_].mark(cell - brick * CellBrick::kEdge);
  }

 private:
  // A hash table with open addressing: numbers of bricks, kEmpty where there is none.
  static constexpr std::uint32_t kEmpty = ~0u;

  std::size_t slot_of(std::uint64_t key) const {
    std::size_t slot = (key * 0x9e3779b97f4a7c15u) >> 32 & (slots_.size() - 1);
    while (slots_[slot] != kEmpty && keys_[slots_[slot]] != key) {
      slot = (slot + 1) & (slots_.size() - 1);
    }
    return slot;
  }
  std::size_t place_of(std::uint64_t key) {
    if (2 * keys_.size() >= slots_.size()) grow();
    std::uint32_t& place = slots_[slot_of(key)];
    if (place == kEmpty) {
      place = static_cast<std::uint32_t>(bricks_.size());
      keys_.push_back(key);
      bricks_.emplace_back();
    }
    return place;
  }
  void grow() {
    slots_.assign(std::max<std::size_t>(1024, 2 * slots_.size()), kEmpty);
    for (std::uint32_t i = 0; i < keys_.size(); ++i) slots_[slot_of(keys_[i])] = i;
  }

  std::vector<std::uint32_t> slots_;  // a power of two of them
  std::vector<std::uint64_t> keys_;   // by brick
  std::vector<CellBrick> bricks_;
  std::size_t last_ = 0;  // the brick of last_key_
  std::uint64_t last_key_ = 0;
};

}  // namespace fovea
