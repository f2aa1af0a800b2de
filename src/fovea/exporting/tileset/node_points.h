// The points of a tileset's nodes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "fovea/exporting/tileset/tile_tree.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea {

/// Reads leaves. Neighbours that are parts of the same tiles read these once.
class LeafReader {
 public:
  /// @param points  of local coordinates; outlives the reader
  explicit LeafReader(const PointStream& points) : points_(points) {}

  /// The chosen points of a leaf, in the map's order. InputError if the map is damaged.
  std::vector<ExportPoint> read(const TileNode& leaf);

 private:
  const PointStream& points_;
  std::vector<TileId> tiles_;
  std::vector<ExportPoint> of_tiles_;
};

/// Numbers of the points that are nearest to the middle of a grid's cells, one for each cell. They
/// are in the order of the first points of the cells.
/// @param low      corner of the grid
/// @param spacing  of the grid
std::vector<std::uint32_t> thinned_numbers(std::span<const ExportPoint> points,
                                           const Eigen::Vector3d& low, double spacing);

/// Of a node's children's points the one nearest to the middle of each cell of the node's grid; the
/// same for the same points in the same order.
std::vector<ExportPoint> thinned(const std::vector<ExportPoint>& points, const TileNode& node);

/// Calls f(node, points) for a node and all below it, children before parents. Memory: the points
/// of a leaf, and thinned ones of one path from the root.
/// @return the node's points
std::vector<ExportPoint> for_each_node(
    const TileNode& node, LeafReader& leaves,
    const std::function<void(const TileNode&, const std::vector<ExportPoint>&)>& f);

}  // namespace fovea
