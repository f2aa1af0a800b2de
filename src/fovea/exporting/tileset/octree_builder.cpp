#include "fovea/exporting/tileset/octree_builder.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <limits>

namespace fovea {
namespace {

constexpr int kGridLevels = 7;  // 128 cells along a node's edge
/// The grid of a node must not be finer than the cells.
constexpr int kMaxLevel = CubeGrid::kLevels - kGridLevels;

/// Of points in Morton order those nearest to the middle of their cell of the node's grid.
std::vector<CubePoint> thinned(const std::vector<CubePoint>& points, const CubeNode& node) {
  const int level = node.level + kGridLevels;
  const double half = std::ldexp(0.5, CubeGrid::kLevels - level);
  std::vector<CubePoint> kept;
  std::array<std::uint32_t, 3> current{};
  double nearest = std::numeric_limits<double>::infinity();
  for (const CubePoint& point : points) {
    const std::array<std::uint32_t, 3> cell = CubeNode::prefix(point.cell, level);
    double distance = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      distance += std::pow(double(point.cell[axis] - cell[axis]) + 0.5 - half, 2);
    }
    if (kept.empty() || cell != current) {
      kept.push_back(point);
      current = cell;
      nearest = distance;
    } else if (distance < nearest) {
      kept.back() = point;
      nearest = distance;
    }
  }
  return kept;
}

class Builder {
 public:
  /// What a node gives to its parent.
  struct Branch {
    std::vector<OctreeTile> tiles;
    std::vector<CubePoint> points;  // of all tiles, for the parent to thin
  };

  Builder(const CubeGrid& grid, const std::function<bool(CubePoint&)>& next,
          const std::function<double(const std::string&, const std::vector<CubePoint>&)>& write,
          const OctreeOptions& options)
      : grid_(grid), next_(next), write_(write), options_(options) {}

  bool at_end() { return !look_ahead(1); }

  /// Takes all points of a node; there is at least one.
  Branch build(const CubeNode& node, const std::string& name) {
    const double edge = std::ldexp(grid_.edge, -node.level);
    const bool last = node.level == kMaxLevel || edge / 2 < options_.min_edge;
    if (last || (edge <= options_.max_leaf_edge && fits_leaf(node))) return leaf(node, name);
    return inner(node, name, edge);
  }

 private:
  /// Whether there are `count` more points; they are in ahead_ then.
  bool look_ahead(std::size_t count) {
    CubePoint point;
    while (ahead_.size() < count && next_(point)) ahead_.push_back(point);
    return ahead_.size() >= count;
  }

  bool fits_leaf(const CubeNode& node) {
    return !look_ahead(options_.leaf_points + 1) || !node.contains(ahead_[options_.leaf_points]);
  }

  bool in(const CubeNode& node) { return look_ahead(1) && node.contains(ahead_.front()); }

  OctreeTile tile(const std::string& name, const std::vector<CubePoint>& points, double spacing) {
    OctreeTile tile{name, spacing, {}};
    for (const CubePoint& point : points) tile.box.extend(grid_.position(point.cell));
    const double margin = write_(name, points);
    tile.box.min().array() -= margin;
    tile.box.max().array() += margin;
    return tile;
  }

  /// One tile, or in a node that is not split further as many as its points need.
  Branch leaf(const CubeNode& node, const std::string& name) {
    Branch branch;
    while (in(node)) {
      std::vector<CubePoint> points;
      while (points.size() < options_.leaf_points && in(node)) {
        points.push_back(ahead_.front());
        ahead_.pop_front();
      }
      const std::string part =
          branch.tiles.empty() ? name : name + "-" + std::to_string(branch.tiles.size());
      branch.tiles.push_back(tile(part, points, 0));
      branch.points.insert(branch.points.end(), points.begin(), points.end());
      if (branch.tiles.size() > 1) branch.points = thinned(branch.points, node);
    }
    return branch;
  }

  Branch inner(const CubeNode& node, const std::string& name, double edge) {
    Branch all;
    while (in(node)) {
      const CubeNode child = node.child(ahead_.front());
      Branch branch = build(child, name + digit(child));
      std::move(branch.tiles.begin(), branch.tiles.end(), std::back_inserter(all.tiles));
      all.points.insert(all.points.end(), branch.points.begin(), branch.points.end());
    }
    if (all.tiles.size() == 1) return all;
    Branch parent;
    parent.points = thinned(all.points, node);
    OctreeTile own = tile(name, parent.points, edge / (1 << kGridLevels));
    for (const OctreeTile& child : all.tiles) own.box.extend(child.box);
    own.children = std::move(all.tiles);
    parent.tiles.push_back(std::move(own));
    return parent;
  }

  /// Which of its parent's eight children a node is.
  static char digit(const CubeNode& node) {
    int number = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto bit = node.low[axis] >> (CubeGrid::kLevels - node.level) & 1;
      number |= static_cast<int>(bit) << axis;
    }
    return static_cast<char>('0' + number);
  }

  const CubeGrid& grid_;
  const std::function<bool(CubePoint&)>& next_;
  const std::function<double(const std::string&, const std::vector<CubePoint>&)>& write_;
  const OctreeOptions& options_;
  std::deque<CubePoint> ahead_;
};

}  // namespace

std::vector<OctreeTile> build_octree(
    const CubeGrid& grid, const std::function<bool(CubePoint&)>& next,
    const std::function<double(const std::string& name, const std::vector<CubePoint>&)>& write_tile,
    const OctreeOptions& options) {
  Builder builder(grid, next, write_tile, options);
  if (builder.at_end()) return {};
  return builder.build(CubeNode{}, "r").tiles;
}

}  // namespace fovea
