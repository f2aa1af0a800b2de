#include "fovea/map/occupancy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr int kBrick = CellBrick::kEdge;
constexpr std::int32_t kNoBrick = -1;
constexpr int kCoarsest = 1 << (kSamplingLevels - 1);  // finest cells along a coarsest one

std::size_t place_in(const Eigen::Array3i& place, const Eigen::Array3i& size) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  return (at(place.z()) * at(size.y()) + at(place.y())) * at(size.x()) + at(place.x());
}

Eigen::Array3i number_of(const TileKey& key) { return {key.x, key.y, key.z}; }

}  // namespace

Occupancy::Occupancy(double tile_size, double spacing)
    : edge_(kCoarsest *
            std::max(1, static_cast<int>(std::ceil(tile_size / spacing / kCoarsest - 0.5)))),
      cell_(tile_size / edge_),
      tiles_per_cell_(1.0 / edge_) {}

int Occupancy::bricks_at(int level) const { return ((edge_ >> level) + kBrick - 1) / kBrick; }

void Occupancy::take_in(const TilePoints& points, Tile& tile) const {
  if (points.size() < tile.points) tile = Tile();  // some have gone
  const double per_step = double(kPositionStep) / cell_;
  const auto mark = [&](std::uint32_t begin, std::uint32_t end, int n) {
    Level& level = tile.levels[std::size_t(n)];
    const Eigen::Array3i bricks = Eigen::Array3i::Constant(bricks_at(n));
    if (level.brick.empty()) level.brick.assign(std::size_t(bricks.prod()), kNoBrick);
    for (std::uint32_t i = begin; i < end; ++i) {
      Eigen::Array3i cell;
      for (int axis = 0; axis < 3; ++axis) {
        const double steps = double(points.position[std::size_t(axis)][i]) + kStepsOn;
        cell[axis] = std::min(static_cast<int>(steps * per_step), edge_ - 1) >> n;
      }
      std::int32_t& brick = level.brick[place_in(CellBrick::number_of(cell), bricks)];
      if (brick == kNoBrick) {
        brick = static_cast<std::int32_t>(level.bricks.size());
        level.bricks.emplace_back();
      }
      level.bricks[static_cast<std::size_t>(brick)].mark(cell);
    }
  };
  const auto known = static_cast<std::uint32_t>(tile.points);
  if (points.sampling_level.empty()) mark(known, std::uint32_t(points.size()), 0);
  points.sampling_level.for_each_run_from(
      known, [&](std::uint32_t begin, std::uint32_t end, std::uint8_t level) {
        mark(begin, end, std::min<int>(level, kSamplingLevels - 1));
        return true;
      });
  tile.points = points.size();
}

void Occupancy::follow(const TileMap& map, const Eigen::Vector3d& center_local, double radius) {
  std::map<TileId, Tile> within_reach;
  std::vector<std::pair<const TilePoints*, Tile*>> changed;
  map.for_each_tile_near(center_local, radius, [&](const TileId& id, const TilePoints& points) {
    auto node = tiles_.extract(id);
    Tile& tile = node ? within_reach.insert(std::move(node)).position->second : within_reach[id];
    if (points.size() != tile.points) changed.emplace_back(&points, &tile);
  });
  parallel_for(changed.size(), 1,
               [&](std::size_t k) { take_in(*changed[k].first, *changed[k].second); });
  tiles_ = std::move(within_reach);
  open_windows(map);
}

void Occupancy::open_windows(const TileMap& map) {
  windows_.clear();
  for (auto begin = tiles_.begin(); begin != tiles_.end();) {
    const std::size_t submap = begin->first.submap;
    const auto end = std::find_if(begin, tiles_.end(),
                                  [&](const auto& entry) { return entry.first.submap != submap; });
    Eigen::Array3i low = Eigen::Array3i::Constant(std::numeric_limits<int>::max());
    Eigen::Array3i high = Eigen::Array3i::Constant(std::numeric_limits<int>::min());
    for (auto entry = begin; entry != end; ++entry) {
      low = low.min(number_of(entry->first.key)).eval();
      high = high.max(number_of(entry->first.key)).eval();
    }
    const RigidMotion T_submap_last =
        map.submaps()[submap].T_local_submap.inverse() * map.submaps().back().T_local_submap;
    Window window;
    window.size = high - low + 1;
    window.tiles.assign(std::size_t(window.size.prod()), nullptr);
    for (; begin != end; ++begin) {
      const auto& [id, tile] = *begin;
      window.tiles[place_in(number_of(id.key) - low, window.size)] = &tile;
      bound(T_submap_last.inverse(), map.tile_size(), id.key, tile, window);
    }
    window.R_cells_last = T_submap_last.linear() / cell_;
    window.t_cells_last =
        T_submap_last.translation() / cell_ - (low * edge_).cast<double>().matrix();
    windows_.push_back(std::move(window));
  }
}

void Occupancy::bound(const RigidMotion& T_last_submap, double tile_size, const TileKey& key,
                      const Tile& tile, Window& window) const {
  constexpr double kMargin = 0.001;  // m, against rounding
  const Eigen::Vector3d low = number_of(key).cast<double>() * tile_size;
  Eigen::AlignedBox3d box(low.array() - kMargin, low.array() + (tile_size + kMargin));
  box.transform(T_last_submap);
  bool has_points = false;
  for (std::size_t level = 0; level < tile.levels.size(); ++level) {
    has_points = has_points || !tile.levels[level].bricks.empty();
    if (has_points) window.box_last[level].extend(box);
  }
}

bool Occupancy::is_marked(const Level& points, int n, const Eigen::Array3i& low, int edge) const {
  const Eigen::Array3i bricks = Eigen::Array3i::Constant(bricks_at(n));
  const std::int32_t brick = points.brick[place_in(CellBrick::number_of(low), bricks)];
  return brick != kNoBrick && points.bricks[static_cast<std::size_t>(brick)].test_cube(low, edge);
}

bool Occupancy::holds_point(const Tile& tile, const Eigen::Array3i& cell, int level,
                            int most) const {
  for (int n = 0; n <= most; ++n) {
    const Level& points = tile.levels[static_cast<std::size_t>(n)];
    if (points.bricks.empty()) continue;
    const int edge = 1 << (level - n);  // of the cell, in cells of these points
    if (edge <= kBrick) {
      if (is_marked(points, n, cell * edge, edge)) return true;
      continue;
    }
    for (int part = 0; part < 8; ++part) {  // two bricks along each axis
      const Eigen::Array3i side(part & 1, part >> 1 & 1, part >> 2);
      if (is_marked(points, n, cell * edge + side * kBrick, kBrick)) return true;
    }
  }
  return false;
}

bool Occupancy::holds_point(const Eigen::Vector3d& p_last, int level, int most) const {
  // The latest submap first: most places are in it.
  for (auto window = windows_.rbegin(); window != windows_.rend(); ++window) {
    if (!window->box_last[std::size_t(most)].contains(p_last)) continue;
    const Eigen::Array3d at = window->R_cells_last * p_last + window->t_cells_last;
    if (!((at >= 0).all() && (at < (window->size * edge_).cast<double>()).all())) continue;
    const Eigen::Array3i cell = at.cast<int>();
    // Faster than a division of integers, and as exact: no quotient is near a whole number.
    const Eigen::Array3i tile = ((cell.cast<double>() + 0.5) * tiles_per_cell_).cast<int>();
    const Tile* found = window->tiles[place_in(tile, window->size)];
    if (found == nullptr) continue;
    const Eigen::Array3i in_tile =
        (cell - tile * edge_).unaryExpr([&](int i) { return i >> level; });
    if (holds_point(*found, in_tile, level, most)) return true;
  }
  return false;
}

}  // namespace fovea
