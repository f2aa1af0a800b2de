// Levels of detail: tiles of an octree from points in Morton order, within a bounded memory.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "fovea/exporting/tileset/cube_grid.h"

namespace fovea {

/// A tile of the tree. Its points stand for those of its children, a coarser picture of the same.
struct OctreeTile {
  std::string name;         ///< digits of the path from the root: "r", "r7", "r70", ...
  double spacing = 0;       ///< m, of the grid that thinned its points; 0: all are there
  Eigen::AlignedBox3d box;  ///< of its points and its children's
  std::vector<OctreeTile> children = {};
};

struct OctreeOptions {
  std::size_t leaf_points = 50'000;  ///< at most in a leaf
  double max_leaf_edge = 32;         ///< m; keeps quantised positions of leaves to a millimetre
  double min_edge = 0.25;            ///< m; nodes are not split further: points there are many
};

/// Builds the tree from the leaves up: a node's points are those of its children thinned by a grid
/// of 128 cells along its edge, in each cell the point nearest to its middle. A node with one child
/// is left out. Memory: the points of one leaf, and thinned ones of one path from the root.
/// @param next       gives the points in Morton order; false at the end
/// @param write_tile called for every tile with its points, children before parents; returns by
///                   how much the points written can lie beyond the given ones, m
/// @return the root, or several where all points lie in one smallest node; empty without points
std::vector<OctreeTile> build_octree(
    const CubeGrid& grid, const std::function<bool(CubePoint&)>& next,
    const std::function<double(const std::string& name, const std::vector<CubePoint>&)>& write_tile,
    const OctreeOptions& options = {});

}  // namespace fovea
