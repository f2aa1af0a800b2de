// Nearest neighbours among 3D points that lie on surfaces about as densely everywhere: built in a
// tenth of a tree's time, kept up to date as points come and go, and asked in less.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/core/lanes.h"
#include "fovea/geometry/neighbor.h"
#include "fovea/geometry/voxel_table.h"

namespace fovea {

/// Points by the cells of a grid, eight side by side. Queries are thread-safe while nothing
/// changes, and do not need the points that it was built from. What is found depends on the points
/// alone, not on the order in which they came and went.
class PointGrid {
 public:
  /// @param cell  edge, m: some times the points' spacing
  explicit PointGrid(float cell) : cell_(cell), table_(cell) {}
  /// Of points whose indices are their places.
  PointGrid(std::span<const Eigen::Vector3f> points, float cell);

  /// @param index  a number of the caller's, which no other point has
  void insert(std::uint32_t index, const Eigen::Vector3f& p);
  /// Removes a point that is there, just as it was inserted.
  void erase(std::uint32_t index, const Eigen::Vector3f& p);

  /// Nearest point within `max_distance`, of equally near ones that of the lowest x, y, z and
  /// index; squared_distance is infinite if there is none. For distances of some cells.
  Neighbor nearest(const Eigen::Vector3f& query, float max_distance) const;

 private:
  struct Block {
    Lanes x, y, z;  // m; far from everything where there is no point
    std::array<std::uint32_t, kLanes> index;
    Eigen::Vector3f point(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    void put(std::size_t lane, const Eigen::Vector3f& p, std::uint32_t number);
  };
  struct Cell {
    std::vector<Block> blocks;
    std::uint32_t count = 0;  // of points: all blocks but the last are full
  };
  struct Best {
    float squared_distance;
    Eigen::Vector3f point;
    std::uint32_t index;
  };
  static void take(const Best& found, Best& best);
  void look_into(const VoxelTable::Voxel& cell, const Eigen::Vector3f& query, Best& best) const;

  float cell_;
  VoxelTable table_;
  std::vector<Cell> cells_;  // by their numbers in the table
};

}  // namespace fovea
