#include "fovea/exporting/tileset/node_points.h"

#include <cmath>
#include <cstdint>

#include "fovea/core/flat_map.h"

namespace fovea {
namespace {

/// Of a cell, each coordinate in 21 bits: nodes are 128 cells wide, and what reaches beyond them
/// less than a tile.
std::uint64_t node_cell_key(const Eigen::Array3d& cell) {
  constexpr double kMiddle = 1 << 20;
  std::uint64_t key = 0;
  for (const double axis : cell) key = key << 21 | static_cast<std::uint64_t>(axis + kMiddle);
  return key;
}

}  // namespace

std::vector<ExportPoint> LeafReader::read(const TileNode& leaf) {
  if (leaf.tiles != tiles_) {
    tiles_.clear();  // what is read half, after an error, is of no tiles
    of_tiles_.clear();
    for (const TileId& id : leaf.tiles) points_.append_tile(id, of_tiles_);
    tiles_ = leaf.tiles;
  }
  std::vector<ExportPoint> points;
  for (const ExportPoint& point : of_tiles_) {
    if (leaf.contains(point.position)) points.push_back(point);
  }
  return points;
}

std::vector<std::uint32_t> thinned_numbers(std::span<const ExportPoint> points,
                                           const Eigen::Vector3d& low, double spacing) {
  struct Nearest {
    std::uint32_t index;
    double distance2;  // cells^2, from the middle
  };
  FlatMap<std::uint32_t> number_of_cell;
  std::vector<Nearest> nearest;  // by the cell's number
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Array3d place = (points[i].position - low).array() / spacing;
    const Eigen::Array3d cell = place.floor();
    const Nearest here{static_cast<std::uint32_t>(i), (place - cell - 0.5).square().sum()};
    const auto [number, is_new] =
        number_of_cell.try_emplace(node_cell_key(cell), static_cast<std::uint32_t>(nearest.size()));
    if (is_new) {
      nearest.push_back(here);
    } else if (here.distance2 < nearest[*number].distance2) {
      nearest[*number] = here;
    }
  }
  std::vector<std::uint32_t> numbers;
  numbers.reserve(nearest.size());
  for (const Nearest& point : nearest) numbers.push_back(point.index);
  return numbers;
}

std::vector<ExportPoint> thinned(const std::vector<ExportPoint>& points, const TileNode& node) {
  std::vector<ExportPoint> kept;
  for (const std::uint32_t number : thinned_numbers(points, node.low, node.spacing)) {
    kept.push_back(points[number]);
  }
  return kept;
}

std::vector<ExportPoint> for_each_node(
    const TileNode& node, LeafReader& leaves,
    const std::function<void(const TileNode&, const std::vector<ExportPoint>&)>& f) {
  std::vector<ExportPoint> points;
  if (node.is_leaf()) {
    points = leaves.read(node);
  } else {
    for (const TileNode& child : node.children) {
      const std::vector<ExportPoint> below = for_each_node(child, leaves, f);
      points.insert(points.end(), below.begin(), below.end());
    }
    points = thinned(points, node);
  }
  f(node, points);
  return points;
}

}  // namespace fovea
