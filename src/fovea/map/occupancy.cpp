#include "fovea/map/occupancy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fovea/core/parallel.h"

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
      cell_(tile_size / edge_) {}

std::size_t Occupancy::place_of(const Cell& brick) const {
  return place_in(brick, Eigen::Array3i::Constant(edge_ / kBrick));
}

void Occupancy::take_in(const TilePoints& points, Tile& tile) const {
  if (points.size() < tile.points || tile.brick.empty()) {  // some have gone, or it is new
    const std::size_t bricks = static_cast<std::size_t>(edge_ / kBrick);
    tile.brick.assign(bricks * bricks * bricks, kNoBrick);
    tile.bricks.clear();
    tile.points = 0;
  }
  const auto per_metre = static_cast<float>(1 / cell_);
  const float beyond = static_cast<float>(kStepsOn) * kPositionStep * per_metre;
  const auto last = static_cast<float>(edge_ - 1);
  std::array<std::array<std::int32_t, 256>, 3> cells;  // along x, y, z; found eight at a time
  while (tile.points < points.size()) {
    const std::size_t n = std::min(cells[0].size(), points.size() - tile.points);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint16_t* steps = &points.position[axis][tile.points];
      for (std::size_t i = 0; i < n; ++i) {
        const float cell = float(steps[i]) * kPositionStep * per_metre + beyond;
        cells[axis][i] = static_cast<std::int32_t>(std::min(std::max(cell, 0.0f), last));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Cell cell(cells[0][i], cells[1][i], cells[2][i]);
      std::int32_t& brick = tile.brick[place_of(CellBrick::number_of(cell))];
      if (brick == kNoBrick) {
        brick = static_cast<std::int32_t>(tile.bricks.size());
        tile.bricks.emplace_back();
      }
      tile.bricks[static_cast<std::size_t>(brick)].mark(cell);
    }
    tile.points += n;
  }
}

void Occupancy::follow(const TileMap& map, const Eigen::Vector3d& center_local, double radius) {
  std::map<TileId, Tile> within_reach;
  std::vector<std::pair<const TilePoints*, Tile*>> tiles;
  map.for_each_tile_near(center_local, radius, [&](const TileId& id, const TilePoints& points) {
    auto node = tiles_.extract(id);
    Tile& tile = node ? within_reach.insert(std::move(node)).position->second : within_reach[id];
    if (points.size() != tile.points) tiles.emplace_back(&points, &tile);
  });
  parallel_for(tiles.size(), 1, [&](std::size_t k) { take_in(*tiles[k].first, *tiles[k].second); });
  tiles_ = std::move(within_reach);
  open_windows(map);
}

void Occupancy::open_windows(const TileMap& map) {
  windows_.clear();
  own_.reset();
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
    const Eigen::Array3i size = high - low + 1;
    Window window;
    window.tiles.assign(size.cast<std::size_t>().prod(), nullptr);
    for (; begin != end; ++begin) {
      window.tiles[place_in(number_of(begin->first.key) - low, size)] = &begin->second;
    }
    window.places = places_of(size);
    window.low = low * (edge_ / kBrick);
    window.bricks = size * (edge_ / kBrick);
    window.size = (size * edge_).cast<double>().matrix();
    const RigidMotion T_submap_last =
        map.submaps()[submap].T_local_submap.inverse() * map.submaps().back().T_local_submap;
    window.R_cells_last = T_submap_last.linear() / cell_;
    window.t_cells_last =
        T_submap_last.translation() / cell_ - (low.cast<double>() * edge_).matrix();
    if (submap + 1 == map.submaps().size()) {
      own_ = std::move(window);
    } else {
      windows_.push_back(std::move(window));
    }
  }
}

std::array<std::vector<Occupancy::Place>, 3> Occupancy::places_of(
    const Eigen::Array3i& tiles) const {
  std::array<std::vector<Place>, 3> places;
  const int bricks = edge_ / kBrick;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Array3i place = Eigen::Array3i::Zero();
    for (int i = 0; i < tiles[axis] * bricks; ++i) {
      place[axis] = i / bricks;
      const auto tile = static_cast<std::uint32_t>(place_in(place, tiles));
      place[axis] = i % bricks;
      places[std::size_t(axis)].push_back({tile, static_cast<std::uint32_t>(place_of(place))});
    }
  }
  return places;
}

bool Occupancy::is_marked(const Window& window, const Eigen::Vector3d& p_last) {
  const Eigen::Vector3d p_cells = window.R_cells_last * p_last + window.t_cells_last;
  // Written so that NaN is nowhere.
  if (!((p_cells.array() >= 0).all() && (p_cells.array() < window.size.array()).all())) {
    return false;
  }
  const Cell cell = p_cells.array().cast<int>();
  const CellBrick* brick = brick_at(window, CellBrick::number_of(cell));
  return brick != nullptr && brick->test(cell);
}

const CellBrick* Occupancy::brick_at(const Window& window, const Eigen::Array3i& place) {
  const Place x = window.places[0][std::size_t(place.x())],
              y = window.places[1][std::size_t(place.y())],
              z = window.places[2][std::size_t(place.z())];
  const Tile* tile = window.tiles[x.tile + y.tile + z.tile];
  if (tile == nullptr) return nullptr;
  const std::int32_t brick = tile->brick[x.brick + y.brick + z.brick];
  return brick == kNoBrick ? nullptr : &tile->bricks[static_cast<std::size_t>(brick)];
}

const CellBrick* Occupancy::brick(const Eigen::Array3i& number) const {
  if (!own_) return nullptr;
  const Eigen::Array3i place = number - own_->low;
  if ((place < 0).any() || (place >= own_->bricks).any()) return nullptr;
  return brick_at(*own_, place);
}

bool Occupancy::taken_before(const Eigen::Vector3d& p_last) const {
  return std::any_of(windows_.rbegin(), windows_.rend(),
                     [&](const Window& window) { return is_marked(window, p_last); });
}

}  // namespace fovea
