#include "fovea/exporting/city/city_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "fovea/exporting/tileset/node_points.h"

namespace fovea {
namespace {

constexpr const char* kRoot = "q";
constexpr double kCellsOnEdge = 128;  // of the grid that thins a node

/// A tile and its cell, counted from the city's southwestern corner.
struct PlacedTile {
  std::size_t number;
  std::int64_t x, y;
};

class TreeMaker {
 public:
  TreeMaker(const City& city, std::int64_t west, std::int64_t south)
      : size_(city.tile_size), corner_(double(west) * size_, double(south) * size_, 0) {}

  /// @param cells  on the edge of the node's square, a power of two
  CityNode make(const std::string& name, std::int64_t x, std::int64_t y, std::int64_t cells,
                const std::vector<PlacedTile>& tiles) const {
    CityNode node;
    node.name = name;
    node.edge = double(cells) * size_;
    node.low = corner_ + size_ * Eigen::Vector3d(double(x), double(y), 0);
    node.tiles = tiles.size();
    if (cells == 1) {
      node.tile = tiles.front().number;
      return node;
    }
    std::array<std::vector<PlacedTile>, 4> quadrants;
    const std::int64_t half = cells / 2;
    for (const PlacedTile& tile : tiles) {
      quadrants[std::size_t(tile.x >= x + half) + 2 * std::size_t(tile.y >= y + half)].push_back(
          tile);
    }
    for (std::size_t i = 0; i < quadrants.size(); ++i) {
      if (quadrants[i].empty()) continue;
      node.children.push_back(make(name + static_cast<char>('0' + i), x + (i & 1 ? half : 0),
                                   y + (i & 2 ? half : 0), half, quadrants[i]));
    }
    // A node with one child is left out, but for the root above a tile.
    const bool is_left_out =
        node.children.size() == 1 && !(name == kRoot && node.children.front().tile);
    return is_left_out ? CityNode(std::move(node.children.front())) : node;
  }

 private:
  double size_;
  Eigen::Vector3d corner_;
};

}  // namespace

CityNode make_city_tree(const City& city, const std::function<CityTileShape(std::size_t)>& shape) {
  if (city.tiles.empty()) return {};
  std::int64_t west = city.tiles.front().tile.x, south = city.tiles.front().tile.y;
  for (const CityTileFile& tile : city.tiles) {
    west = std::min<std::int64_t>(west, tile.tile.x);
    south = std::min<std::int64_t>(south, tile.tile.y);
  }
  std::vector<PlacedTile> placed;
  std::int64_t cells = 1;
  for (std::size_t i = 0; i < city.tiles.size(); ++i) {
    const CityTile& tile = city.tiles[i].tile;
    placed.push_back({i, tile.x - west, tile.y - south});
    while (cells <= std::max(placed.back().x, placed.back().y)) cells *= 2;
  }
  cells = std::max<std::int64_t>(cells, 2);  // the root is no tile
  CityNode root = TreeMaker(city, west, south).make(kRoot, 0, 0, cells, placed);
  fit_city_tree(root, city, shape);
  return root;
}

void fit_city_tree(CityNode& node, const City& city,
                   const std::function<CityTileShape(std::size_t)>& shape) {
  node.box.setEmpty();
  if (node.tile) {
    const CityTileShape of_tile = shape(*node.tile);
    node.spacing = of_tile.spacing;
    node.tile_box = of_tile.box;
    if (of_tile.box.isEmpty()) return;
    const RigidMotion T_local_tile = city.T_local_tile(city.tiles[*node.tile].tile);
    for (int i = 0; i < 8; ++i) {
      node.box.extend(T_local_tile * of_tile.box.corner(Eigen::AlignedBox3d::CornerType(i)));
    }
    return;
  }
  node.spacing = node.edge / kCellsOnEdge;
  for (CityNode& child : node.children) {
    fit_city_tree(child, city, shape);
    node.box.extend(child.box);
    // Viewers expect that the error shrinks from a level to the next one.
    node.spacing = std::max(node.spacing, 2 * child.spacing);
  }
}

std::vector<ExportPoint> for_each_city_node(
    const CityNode& node,
    const std::function<std::optional<std::vector<ExportPoint>>(const CityNode&)>& known,
    const std::function<void(const CityNode&, const std::vector<ExportPoint>&)>& f) {
  if (auto points = known(node)) return std::move(*points);
  std::vector<ExportPoint> points;
  for (const CityNode& child : node.children) {
    const std::vector<ExportPoint> below = for_each_city_node(child, known, f);
    points.insert(points.end(), below.begin(), below.end());
  }
  points = thinned_to_node(std::move(points), node);
  f(node, points);
  return points;
}

std::vector<ExportPoint> thinned_to_node(std::vector<ExportPoint> points, const CityNode& node) {
  TileNode grid;
  grid.low = node.low;
  grid.spacing = node.spacing;
  points = thinned(points, grid);
  while (points.size() > kMostPointsOfNode) {
    grid.spacing *= 2;
    points = thinned(points, grid);
  }
  return points;
}

std::vector<std::size_t> tiles_that_show(const CityNode& node) {
  std::vector<std::size_t> tiles;
  const std::function<void(const CityNode&)> collect = [&](const CityNode& below) {
    if (below.tile) return tiles.push_back(*below.tile);
    if (below.edge <= node.spacing) return collect(below.children.front());
    for (const CityNode& child : below.children) collect(child);
  };
  collect(node);
  return tiles;
}

void transform_points(const RigidMotion& T, std::vector<ExportPoint>& points) {
  for (ExportPoint& point : points) point.position = T * point.position;
}

}  // namespace fovea
