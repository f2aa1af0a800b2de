// Sets of cells of a fine grid, for surfaces: a piece of surface fills some cells, space none.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>

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
    if (last_ == nullptr || key != last_key_) {
      last_ = &bricks_[key];
      last_key_ = key;
    }
    return last_->mark(cell - brick * CellBrick::kEdge);
  }

 private:
  std::unordered_map<std::uint64_t, CellBrick> bricks_;
  CellBrick* last_ = nullptr;  // elements of an unordered_map stay where they are
  std::uint64_t last_key_ = 0;
};

}  // namespace fovea
