// Points as cells of a cube that is halved 32 times along each axis: the places of an octree.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>

#include "fovea/base/image.h"

namespace fovea {

/// A point of a tileset, 16 bytes. Within 4000 km a cell is below 1 mm, within 1 km 0.3 um.
struct CubePoint {
  std::array<std::uint32_t, 3> cell{};
  Rgb color;
  friend bool operator==(const CubePoint&, const CubePoint&) = default;
};

/// The cube around a map.
struct CubeGrid {
  static constexpr int kLevels = 32;

  explicit CubeGrid(const Eigen::AlignedBox3d& box)
      : low(box.min()), edge(std::max(box.sizes().maxCoeff() * (1 + 1e-9), 1e-3)) {}

  std::array<std::uint32_t, 3> cell(const Eigen::Vector3d& p) const {
    std::array<std::uint32_t, 3> cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = (p[axis] - low[axis]) / edge * kCells;
      cell[std::size_t(axis)] = static_cast<std::uint32_t>(std::clamp(steps, 0.0, kCells - 1));
    }
    return cell;
  }
  /// Of a cell's middle.
  Eigen::Vector3d position(const std::array<std::uint32_t, 3>& cell) const {
    return low +
           edge / kCells * (Eigen::Vector3d(cell[0], cell[1], cell[2]).array() + 0.5).matrix();
  }

  Eigen::Vector3d low;
  double edge;

 private:
  static constexpr double kCells = 4294967296.0;  // 2^kLevels
};

/// Morton order (z-order), in which the points of every node of the octree stand together; points
/// of one cell by colour, so that equal sets of points have one order.
inline bool morton_less(const CubePoint& a, const CubePoint& b) {
  std::size_t axis = 0;
  std::uint32_t most = 0;  // the axis whose highest differing bit is highest decides
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t differing = a.cell[i] ^ b.cell[i];
    if (most < differing && most < (most ^ differing)) {
      axis = i;
      most = differing;
    }
  }
  if (most != 0) return a.cell[axis] < b.cell[axis];
  const auto number = [](Rgb c) { return (c.r << 16) | (c.g << 8) | c.b; };
  return number(a.color) < number(b.color);
}

/// A cube of the octree: `level` halvings of the whole, its lowest cell.
struct CubeNode {
  int level = 0;
  std::array<std::uint32_t, 3> low{};

  bool contains(const CubePoint& point) const { return prefix(point.cell, level) == low; }
  /// The child that a point of this node lies in.
  CubeNode child(const CubePoint& point) const {
    return {level + 1, prefix(point.cell, level + 1)};
  }

  /// The lowest cell of the node of that level which has `cell`.
  static std::array<std::uint32_t, 3> prefix(std::array<std::uint32_t, 3> cell, int level) {
    const auto mask = static_cast<std::uint32_t>(~std::uint64_t{0} << (CubeGrid::kLevels - level));
    for (std::uint32_t& axis : cell) axis &= mask;
    return cell;
  }
};

}  // namespace fovea
