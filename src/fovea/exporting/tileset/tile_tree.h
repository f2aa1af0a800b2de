// A map's levels of detail: an octree of the local frame whose leaves are the map's own tiles, so
// that any node can be read from the map without sorting it.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// A node. Its points stand for those of its children, a coarser picture of the same.
struct TileNode {
  std::string name;    ///< digits of the path from the root: "r", "r7", "r70", ...
  double spacing = 0;  ///< m, of the grid that thins its children's points; 0: a leaf
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< local frame, corner of its cube
  Eigen::AlignedBox3d box;                        ///< local frame, m; all of its points lie in it
  /// Of a leaf: the tiles that its points are of, and the part of space that these lie in, which is
  /// more than its cube where tiles reach beyond theirs.
  std::vector<TileId> tiles = {};
  Eigen::AlignedBox3d part = {};
  std::vector<TileNode> children = {};

  bool is_leaf() const { return children.empty(); }
  /// A point on a face between two leaves belongs to the upper one.
  bool contains(const Eigen::Vector3d& p_local) const {
    return (p_local.array() >= part.min().array()).all() &&
           (p_local.array() < part.max().array()).all();
  }
};

struct TileTreeOptions {
  /// About so many in a leaf at most; parts of a tile count as surfaces, a quarter each.
  std::size_t leaf_points = 65536;
  double max_leaf_edge = 32;  ///< m; keeps quantised positions of leaves to a third of a millimetre
  double min_edge = 0.25;     ///< m; nodes are not split further: points there are many
};

/// A tile belongs to the cube that its middle lies in. A node with one child is left out.
/// @param tiles           and how many points each has
/// @param tile_size       edge of the tiles, m
/// @param T_local_submap  by submap
/// @return the root; without tiles a leaf of none
/// std::invalid_argument if a tile's submap does not exist; InputError if its pose is not finite or
/// the tiles lie over 1000 km apart.
TileNode make_tile_tree(std::span<const std::pair<TileId, std::size_t>> tiles, double tile_size,
                        const std::vector<RigidMotion>& T_local_submap,
                        const TileTreeOptions& options = {});
/// Of all that a map has; InputError if it does not tell the size of its tiles.
TileNode make_tile_tree(const MapReader& map, const TileTreeOptions& options = {});

}  // namespace fovea
