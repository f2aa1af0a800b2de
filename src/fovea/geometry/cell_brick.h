// Sets of cells of a fine grid. Bricks suit surfaces, which fill some cells near each other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "fovea/core/flat_map.h"
#include "fovea/platform.h"

namespace fovea {

/// A number for a cell of a grid, each coordinate within 2^20.
inline std::uint64_t cell_key(const Eigen::Array3i& cell) {
  std::uint64_t key = 0;
  for (const int i : cell) key = key << 21 | (static_cast<std::uint64_t>(i) & 0x1fffff);
  return key;
}

/// Quantized positions often lie on cell borders. Offset them by this many steps before flooring,
/// so that the result does not depend on rounding.
inline constexpr double kStepsOn = 0.1;

/// 8 x 8 x 8 cells, one bit for each.
class CellBrick {
 public:
  static constexpr int kEdge = 8;  ///< cells

  /// A number that belongs to no brick.
  static Eigen::Array3i no_number() {
    return Eigen::Array3i::Constant(std::numeric_limits<int>::min());
  }
  /// Whether two numbers of bricks are equal, with one branch. Most searches are for the same brick
  /// as the search before.
  static bool same(const Eigen::Array3i& a, const Eigen::Array3i& b) {
    return ((a.x() ^ b.x()) | (a.y() ^ b.y()) | (a.z() ^ b.z())) == 0;
  }

  /// Number of a cell's brick: the cell's coordinates divided by kEdge, rounded down.
  static Eigen::Array3i number_of(const Eigen::Array3i& cell) {
    return cell.unaryExpr([](int i) { return i >> 3; });  // a division would round toward zero
  }

  /// @param cell  of the grid; only its place in its brick counts
  bool test(const Eigen::Array3i& cell) const {
    return (layers_[layer(cell)] >> bit(cell) & 1) != 0;
  }
  /// Whether a cell of a cube is marked.
  /// @param low   its lowest cell: multiples of `edge`
  /// @param edge  in cells: 1, 2, 4 or 8
  bool test_cube(const Eigen::Array3i& low, int edge) const {
    if (edge == 1) return test(low);
    std::uint64_t square = 0;  // of a layer
    for (int y = 0; y < edge; ++y) {
      square |= (~std::uint64_t{0} >> (64 - edge)) << bit(low + Eigen::Array3i(0, y, 0));
    }
    for (int z = 0; z < edge; ++z) {
      if ((layers_[layer(low) + std::size_t(z)] & square) != 0) return true;
    }
    return false;
  }
  /// @return whether the cell is new
  bool mark(const Eigen::Array3i& cell) {
    std::uint64_t& bits = layers_[layer(cell)];
    const std::uint64_t before = bits;
    bits |= std::uint64_t{1} << bit(cell);
    return bits != before;
  }

 private:
  static std::size_t layer(const Eigen::Array3i& cell) {
    return static_cast<std::size_t>(cell.z() & 7);
  }
  static int bit(const Eigen::Array3i& cell) { return (cell.y() & 7) * kEdge + (cell.x() & 7); }
  std::array<std::uint64_t, kEdge> layers_{};
};

/// A set of cells; fast if successive cells are near each other.
class CellSet {
 public:
  /// @param cell  each coordinate within 2^23
  /// @return whether the cell is new
  bool mark(const Eigen::Array3i& cell) {
    const Eigen::Array3i brick = CellBrick::number_of(cell);
    if (!CellBrick::same(brick, last_brick_)) go_to(brick);
    return bricks_[last_].mark(cell);
  }

 private:
  void go_to(const Eigen::Array3i& brick) {
    const auto [number, is_new] =
        number_of_brick_.try_emplace(cell_key(brick), static_cast<std::uint32_t>(bricks_.size()));
    if (is_new) bricks_.emplace_back();
    last_ = *number;
    last_brick_ = brick;
  }

  FlatMap<std::uint32_t> number_of_brick_;
  std::vector<CellBrick> bricks_;
  std::uint32_t last_ = 0;  // place of the brick of the last cell
  Eigen::Array3i last_brick_ = CellBrick::no_number();
};

}  // namespace fovea
