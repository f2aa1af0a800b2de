// The levels of detail of a city: a quadtree over its tiles.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fovea/city/city.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea {

/// What the tree must know of a tile.
struct CityTileShape {
  Eigen::AlignedBox3d box;  ///< of its points, in the tile's frame
  double spacing = 0;       ///< of the points of its coarsest level, m; 0: all points
};

/// A tile of the city, or a coarse picture of up to four nodes.
struct CityNode {
  std::string name;                               ///< digits of the path from the root: "q", "q0"
  double edge = 0;                                ///< of its square, m
  double spacing = 0;                             ///< m, of the grid that thins its points
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< city frame, corner of its square
  Eigen::AlignedBox3d box;                        ///< city frame; all of its points lie in it
  std::size_t tiles = 0;                          ///< below it
  std::optional<std::size_t> tile = {};           ///< number in City::tiles, if it is one
  Eigen::AlignedBox3d tile_box = {};              ///< of a tile, in its own frame
  std::vector<CityNode> children = {};
};

/// @param shape  of each tile of the city, by its number
/// @return the root, which is no tile; without tiles a node without children
CityNode make_city_tree(const City& city,
                        const std::function<CityTileShape(std::size_t tile)>& shape);

/// Computes the boxes and spacings of a node and all below again.
void fit_city_tree(CityNode& node, const City& city,
                   const std::function<CityTileShape(std::size_t tile)>& shape);

/// The points of a node, in the city's frame: those of its children, thinned. Memory: the points of
/// one path from the node.
/// @param known  the points of a node where these are known, as they are of each tile; nothing for
///               other nodes
/// @param f      called with each other node and its points, children before parents
std::vector<ExportPoint> for_each_city_node(
    const CityNode& node,
    const std::function<std::optional<std::vector<ExportPoint>>(const CityNode&)>& known,
    const std::function<void(const CityNode&, const std::vector<ExportPoint>&)>& f);

/// A node whose grid has more cells with points is thinned further.
inline constexpr std::size_t kMostPointsOfNode = 65536;

/// The points of a node, of the points of its tiles or children. In the city's frame.
std::vector<ExportPoint> thinned_to_node(std::vector<ExportPoint> points, const CityNode& node);

/// Numbers of the tiles whose points are enough for a node. Where several tiles lie in one cell of
/// the node's grid, one of them is enough. So the number is bounded in a city of any size.
std::vector<std::size_t> tiles_that_show(const CityNode& node);

/// Moves points to another frame.
void transform_points(const RigidMotion& T, std::vector<ExportPoint>& points);

}  // namespace fovea
