#include "fovea/exporting/tileset/tile_tree.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fovea/errors.h"
#include "fovea/map/map_meta.h"

namespace fovea {
namespace {

constexpr double kMaxSpan = 1e6;      // m
constexpr double kRounding = 1e-3;    // m, positions are kept in millimetres
constexpr double kCellsOnEdge = 128;  // of the grid that thins a node

struct PlacedTile {
  TileId id;
  std::size_t points = 0;
  Eigen::Vector3d middle;   // local
  Eigen::AlignedBox3d box;  // local, of the tile's cube
};

PlacedTile place(const TileId& id, std::size_t points, double tile_size,
                 const RigidMotion& T_local_submap) {
  const Eigen::Vector3d low = Eigen::Vector3d(id.key.x, id.key.y, id.key.z) * tile_size;
  const Eigen::AlignedBox3d cube(low, low + Eigen::Vector3d::Constant(tile_size));
  PlacedTile tile{id, points, T_local_submap * cube.center(), {}};
  for (int i = 0; i < 8; ++i) {
    tile.box.extend(T_local_submap * cube.corner(Eigen::AlignedBox3d::CornerType(i)));
  }
  tile.box.min().array() -= kRounding;
  tile.box.max().array() += kRounding;
  return tile;
}

/// The part of a box on one side of a plane across an axis.
Eigen::AlignedBox3d half(Eigen::AlignedBox3d box, int axis, double at, bool upper) {
  (upper ? box.min() : box.max())[axis] = at;
  return box;
}

class TreeMaker {
 public:
  TreeMaker(double tile_size, const TileTreeOptions& options)
      : tile_size_(tile_size), options_(options) {}

  /// @param edge    of the node's cube
  /// @param points  about so many in `part` of the tiles
  TileNode make(const std::string& name, const Eigen::Vector3d& low, double edge,
                const std::vector<PlacedTile>& tiles, const Eigen::AlignedBox3d& part,
                std::size_t points) const {
    const bool small = points <= options_.leaf_points && edge <= options_.max_leaf_edge;
    if (small || edge / 2 < options_.min_edge) return leaf(name, low, tiles, part);
    TileNode node{name, edge / kCellsOnEdge, low, {}};
    const bool by_tiles = edge > tile_size_ * 1.5;  // the edge is a tile's times a power of two
    std::array<std::vector<PlacedTile>, 8> octants;
    if (by_tiles) {
      octants = sorted_into_octants(tiles, low, edge);
    } else {
      octants.fill(tiles);
    }
    for (std::size_t i = 0; i < 8; ++i) {
      Eigen::Vector3d child_low = low;
      Eigen::AlignedBox3d child_part = part;
      for (int axis = 0; axis < 3; ++axis) {
        const bool upper = i >> axis & 1;
        if (upper) child_low[axis] += edge / 2;
        if (!by_tiles) child_part = half(child_part, axis, low[axis] + edge / 2, upper);
      }
      if (box_of(octants[i], child_part).isEmpty()) continue;
      node.children.push_back(make(name + static_cast<char>('0' + i), child_low, edge / 2,
                                   octants[i], child_part,
                                   by_tiles ? sum_of_points(octants[i]) : points / 4));
      node.box.extend(node.children.back().box);
    }
    return node.children.size() == 1 ? TileNode(std::move(node.children.front())) : node;
  }

  static std::size_t sum_of_points(const std::vector<PlacedTile>& tiles) {
    std::size_t sum = 0;
    for (const PlacedTile& tile : tiles) sum += tile.points;
    return sum;
  }

 private:
  static TileNode leaf(const std::string& name, const Eigen::Vector3d& low,
                       const std::vector<PlacedTile>& tiles, const Eigen::AlignedBox3d& part) {
    TileNode leaf{name, 0, low, {}};
    leaf.part = part;
    leaf.box = box_of(tiles, part);
    for (const PlacedTile& tile : tiles) leaf.tiles.push_back(tile.id);
    return leaf;
  }

  static Eigen::AlignedBox3d box_of(const std::vector<PlacedTile>& tiles,
                                    const Eigen::AlignedBox3d& part) {
    Eigen::AlignedBox3d box;
    for (const PlacedTile& tile : tiles) box.extend(tile.box);
    return box.isEmpty() ? box : box.intersection(part);
  }

  static std::array<std::vector<PlacedTile>, 8> sorted_into_octants(
      const std::vector<PlacedTile>& tiles, const Eigen::Vector3d& low, double edge) {
    std::array<std::vector<PlacedTile>, 8> octants;
    for (const PlacedTile& tile : tiles) {
      std::size_t octant = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (tile.middle[axis] >= low[axis] + edge / 2) octant |= std::size_t{1} << axis;
      }
      octants[octant].push_back(tile);
    }
    return octants;
  }

  double tile_size_;
  const TileTreeOptions& options_;
};

}  // namespace

TileNode make_tile_tree(std::span<const std::pair<TileId, std::size_t>> tiles, double tile_size,
                        const std::vector<RigidMotion>& T_local_submap,
                        const TileTreeOptions& options) {
  std::vector<PlacedTile> placed;
  Eigen::AlignedBox3d middles;
  for (const auto& [id, points] : tiles) {
    if (id.submap >= T_local_submap.size()) {
      throw std::invalid_argument(fmt::format("there is no submap {}", id.submap));
    }
    placed.push_back(place(id, points, tile_size, T_local_submap[id.submap]));
    if (!placed.back().middle.allFinite()) {
      throw InputError("the pose of a submap is not finite", "the map's submaps", kRestoreMap);
    }
    middles.extend(placed.back().middle);
  }
  if (placed.empty()) return {"r", 0, Eigen::Vector3d::Zero(), {}};
  const Eigen::Vector3d low = (middles.min() / tile_size).array().floor() * tile_size;
  const double span = (middles.max() - low).maxCoeff();
  if (!(span <= kMaxSpan)) {
    throw InputError(fmt::format("the map's points lie up to {:.0f} km apart", span / 1000),
                     "the map's tiles", "cut out the part you need (fovea crop)");
  }
  double edge = tile_size;
  while (edge <= span) edge *= 2;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const Eigen::AlignedBox3d everywhere(Eigen::Vector3d::Constant(-kFar),
                                       Eigen::Vector3d::Constant(kFar));
  const TreeMaker maker(tile_size, options);
  return maker.make("r", low, edge, placed, everywhere, TreeMaker::sum_of_points(placed));
}

TileNode make_tile_tree(const MapReader& map, const TileTreeOptions& options) {
  const auto tiles = map.tile_sizes();
  if (tiles.empty()) return make_tile_tree({}, 1, {}, options);
  return make_tile_tree(tiles, map_tile_size(map.meta()), map.submaps(), options);
}

}  // namespace fovea
