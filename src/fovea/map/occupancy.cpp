#include "fovea/map/occupancy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fovea {
namespace {

constexpr int kBrick = CellBrick::kEdge;
constexpr std::int32_t kNoBrick = -1;

std::size_t place_in(const Eigen::Array3i& place, const Eigen::Array3i& size) {
  return static_cast<std::size_t>((place.z() * size.y() + place.y()) * size.x() + place.x());
}

Eigen::Array3i number_of(const TileKey& key) { return {key.x, key.y, key.z}; }

}  // namespace

Occupancy::Occupancy(double tile_size, double spacing)
    : edge_(kBrick * std::max(1, static_cast<int>(std::lround(tile_size / spacing / kBrick)))),
      tile_size_(tile_size),
      cell_(tile_size / edge_) {}

std::size_t Occupancy::place_of(const Cell& brick) const {
  return place_in(brick, Eigen::Array3i::Constant(edge_ / kBrick));
}

void Occupancy::take_in(const PointCloud& points, Tile& tile) const {
  if (points.size() < tile.points || tile.brick.empty()) {  // some have gone, or it is new
    const std::size_t bricks = static_cast<std::size_t>(edge_ / kBrick);
    tile.brick.assign(bricks * bricks * bricks, kNoBrick);
    tile.bricks.clear();
    tile.points = 0;
  }
  const auto per_metre = static_cast<float>(1 / cell_);
  for (; tile.points < points.size(); ++tile.points) {
    const Cell cell = (points.position[tile.points].array() * per_metre)
                          .floor()
                          .cast<int>()
                          .max(0)
                          .min(edge_ - 1);
    const Cell place = cell / kBrick;
    std::int32_t& brick = tile.brick[place_of(place)];
    if (brick == kNoBrick) {
      brick = static_cast<std::int32_t>(tile.bricks.size());
      tile.bricks.emplace_back();
    }
    tile.bricks[static_cast<std::size_t>(brick)].mark(cell - place * kBrick);
  }
}

void Occupancy::follow(const TileMap& map, const Eigen::Vector3d& center_local, double radius) {
  std::map<TileId, Tile> within_reach;
  map.for_each_tile_near(center_local, radius, [&](const TileId& id, const PointCloud& points) {
    auto node = tiles_.extract(id);
    Tile& tile = node ? within_reach.insert(std::move(node)).position->second : within_reach[id];
    take_in(points, tile);
  });
  tiles_ = std::move(within_reach);
  open_windows(map);
}

void Occupancy::open_windows(const TileMap& map) {
  windows_.clear();
  for (auto begin = tiles_.begin(); begin != tiles_.end();) {
    const std::size_t submap = begin->first.submap;
    const auto end = std::find_if(begin, tiles_.end(),
                                  [&](const auto& entry) { return entry.first.submap != submap; });
    Window window;
    window.low.setConstant(std::numeric_limits<int>::max());
    Eigen::Array3i high = Eigen::Array3i::Constant(std::numeric_limits<int>::min());
    for (auto entry = begin; entry != end; ++entry) {
      window.low = window.low.min(number_of(entry->first.key)).eval();
      high = high.max(number_of(entry->first.key)).eval();
    }
    window.size = high - window.low + 1;
    window.tiles.assign(window.size.cast<std::size_t>().prod(), nullptr);
    for (; begin != end; ++begin) {
      window.tiles[place_in(number_of(begin->first.key) - window.low, window.size)] =
          &begin->second;
    }
    const RigidMotion T_submap_last =
        map.submaps()[submap].T_local_submap.inverse() * map.submaps().back().T_local_submap;
    window.R_submap_last = T_submap_last.linear();
    window.t_submap_last = T_submap_last.translation();
    windows_.push_back(std::move(window));
  }
}

bool Occupancy::is_marked(const Window& window, const Eigen::Vector3d& p_submap) const {
  const Eigen::Array3d tile_number = (p_submap.array() / tile_size_).floor();
  const Eigen::Array3i place = tile_number.cast<int>() - window.low;
  if ((place < 0).any() || (place >= window.size).any()) return false;
  const Tile* tile = window.tiles[place_in(place, window.size)];
  if (tile == nullptr) return false;
  const Cell cell =
      ((p_submap.array() - tile_number * tile_size_) / cell_).cast<int>().max(0).min(edge_ - 1);
  const Cell brick_place = cell / kBrick;
  const std::int32_t brick = tile->brick[place_of(brick_place)];
  return brick != kNoBrick &&
         tile->bricks[static_cast<std::size_t>(brick)].test(cell - brick_place * kBrick);
}

bool Occupancy::taken(const Eigen::Vector3d& p_grid) const {
  return std::any_of(windows_.rbegin(), windows_.rend(), [&](const Window& window) {
    return is_marked(window, window.R_submap_last * p_grid + window.t_submap_last);
  });
}

}  // namespace fovea
