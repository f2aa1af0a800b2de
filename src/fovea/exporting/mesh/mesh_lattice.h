// The lattice that all meshes of a map are cut from: cubic blocks of voxels, and voxels of cells.
#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstdint>

#include "fovea/platform.h"

namespace fovea {

/// Voxels along a block's edge.
inline constexpr int kBlockVoxels = 128;
/// Cells along a voxel's edge: a surface is seen at one point a cell at most.
inline constexpr int kVoxelCells = 2;
inline constexpr int kBlockCells = kBlockVoxels * kVoxelCells;

/// A block of a level of detail: it spans [x, x + 1) * edge, ... from the lattice's origin.
struct BlockKey {
  std::int32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const BlockKey&, const BlockKey&) = default;

  Eigen::Array3i array() const { return {x, y, z}; }
  static BlockKey of(const Eigen::Array3i& a) { return {a.x(), a.y(), a.z()}; }
  /// Of the next coarser level, whose voxels are twice as large.
  BlockKey parent() const { return {x >> 1, y >> 1, z >> 1}; }
};

/// Edge of a block, m.
inline double block_edge(double voxel) { return kBlockVoxels * voxel; }

}  // namespace fovea
