#include "fovea/map/tile_map.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/map/points_in_tiles.h"

namespace fovea {
namespace {

/// Stored floats may round to just outside their tile; relative to the tile's edge.
constexpr double kRoundingMargin = 1e-6;

/// Indices of tiles that [low, high] m may touch, clamped to what a key can hold.
std::pair<std::int32_t, std::int32_t> index_range(double low, double high, double tile_size) {
  constexpr double kMin = std::numeric_limits<std::int32_t>::min();
  constexpr double kMax = std::numeric_limits<std::int32_t>::max();
  return {static_cast<std::int32_t>(std::clamp(std::floor(low / tile_size), kMin, kMax)),
          static_cast<std::int32_t>(std::clamp(std::floor(high / tile_size), kMin, kMax))};
}

std::string name_of(const TileId& id) {
  return fmt::format("tile {} {} {} of submap {}", id.key.x, id.key.y, id.key.z, id.submap);
}

/// Has the submap's box hold a tile.
void widen(Submap& submap, const TileKey& key) {
  if (submap.tiles.size() + submap.stored.size() == 1) submap.low = submap.high = key;
  submap.low = {std::min(submap.low.x, key.x), std::min(submap.low.y, key.y),
                std::min(submap.low.z, key.z)};
  submap.high = {std::max(submap.high.x, key.x), std::max(submap.high.y, key.y),
                 std::max(submap.high.z, key.z)};
}

}  // namespace

TilePoints& Tile::edit() {
  if (!has_changed_) points = std::make_shared<TilePoints>(*points);
  has_changed_ = true;
  return const_cast<TilePoints&>(*points);  // not shared, and not const where it was made
}

TileMap::TileMap(double tile_size) : tile_size_(tile_size) {
  if (!(tile_size > 0 && tile_size <= kMaxTileSize)) {
    throw std::invalid_argument(
        fmt::format("tile size {} m is not within 0 and {} m", tile_size, kMaxTileSize));
  }
}

Eigen::Vector3d TileMap::corner(const TileKey& key) const {
  return Eigen::Vector3d(key.x, key.y, key.z) * tile_size_;
}

void TileMap::require_same_columns(bool has_intensity) {
  if (has_intensity_.value_or(has_intensity) != has_intensity) {
    throw std::logic_error("only some points of the map have the column 'intensity'");
  }
  has_intensity_ = has_intensity;
}

void TileMap::add_submap(const RigidMotion& T_local_submap) {
  if (!T_local_submap.matrix().allFinite()) {
    throw std::invalid_argument("the pose of a submap is not finite");
  }
  submaps_.emplace_back().T_local_submap = T_local_submap;
}

void TileMap::move_submap(std::size_t submap, const RigidMotion& T_local_submap) {
  if (submap >= submaps_.size()) {
    throw std::logic_error(fmt::format("submap {} does not exist", submap));
  }
  if (!T_local_submap.matrix().allFinite()) {
    throw std::invalid_argument("the pose of a submap is not finite");
  }
  submaps_[submap].T_local_submap = T_local_submap;
}

void TileMap::place_submaps(const std::vector<RigidMotion>& poses) {
  for (std::size_t id = 0; id < poses.size(); ++id) {
    if (id < submaps_.size()) {
      move_submap(id, poses[id]);
    } else {
      add_submap(poses[id]);
    }
  }
}

void TileMap::set_gains(const std::vector<LogGain>& log2_gains) {
  if (log2_gains.size() > submaps_.size()) throw std::logic_error("a gain of no submap");
  for (std::size_t id = 0; id < log2_gains.size(); ++id) submaps_[id].log2_gain = log2_gains[id];
}

void TileMap::add(const PointCloud& points_local) {
  if (submaps_.empty()) throw std::logic_error("points need a submap to be added to");
  if (points_local.empty()) return;
  check_tile_columns(points_local);
  require_same_columns(!points_local.intensity.empty());
  Submap& submap = submaps_.back();

  const PointsInTiles placed = points_in_tiles(
      points_local.position,
      submap.T_local_submap.inverse() * Eigen::Translation3d(points_local.origin), tile_size_);
  using Ranges = std::vector<TilePoints::Range>;
  std::vector<std::pair<Tile*, const Ranges*>> additions;
  for (const auto& [key, ranges] : placed.ranges) {
    if (submap.stored.contains(key)) {
      throw std::logic_error(fmt::format("points for {}, which is not in memory",
                                         name_of({submaps_.size() - 1, key})));
    }
    const auto [place, is_new] = submap.tiles.try_emplace(key);
    if (is_new) {
      place->second.edit().origin = corner(key);
      widen(submap, key);
    }
    additions.emplace_back(&place->second, &ranges);
  }
  parallel_for(additions.size(), 1, [&](std::size_t k) {
    additions[k].first->edit().append(points_local, placed.position, *additions[k].second);
  });
  size_ += points_local.size();
  size_in_memory_ += points_local.size();
}

Tile& TileMap::existing_tile(const TileId& id) {
  if (id.submap < submaps_.size()) {
    const auto found = submaps_[id.submap].tiles.find(id.key);
    if (found != submaps_[id.submap].tiles.end()) return found->second;
  }
  throw std::logic_error(name_of(id) + " is not in memory");
}

void TileMap::keep_points(const TileId& id, const std::vector<std::uint32_t>& indices) {
  Tile& tile = existing_tile(id);
  const std::size_t lost = tile.points->size() - indices.size();
  size_ -= lost;
  size_in_memory_ -= lost;
  if (indices.empty()) {
    submaps_[id.submap].tiles.erase(id.key);
    removed_.push_back(id);
  } else {
    tile.edit().keep(indices);
  }
}

std::span<FusedColor> TileMap::colors(const TileId& id) { return existing_tile(id).edit().colors; }

void TileMap::put_camera(const TileId& id, std::span<const std::uint32_t> indices,
                         std::int8_t camera) {
  existing_tile(id).edit().camera.put(indices, camera);
}

template <class Tiles, class F>
void TileMap::for_each_near(Tiles Submap::* tiles, const Eigen::Vector3d& center_local,
                            double radius, F&& f) const {
  const double reach = radius + kRoundingMargin * tile_size_;
  if (!(reach >= 0)) return;
  constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
  const auto touches = [&](const Eigen::Array3d& center, const TileKey& low, const TileKey& high) {
    const Eigen::Array3d nearest =
        center.max(corner(low).array()).min(corner(high).array() + tile_size_);
    return (nearest - center).matrix().squaredNorm() <= reach * reach;
  };
  for (std::size_t id = 0; id < submaps_.size(); ++id) {
    const Submap& submap = submaps_[id];
    const auto& of_submap = submap.*tiles;
    if (of_submap.empty()) continue;
    const Eigen::Vector3d center = submap.T_local_submap.inverse() * center_local;
    if (!touches(center.array(), submap.low, submap.high)) continue;  // most of a long drive's
    const auto [x_first, x_last] = index_range(center.x() - reach, center.x() + reach, tile_size_);
    for (auto it = of_submap.lower_bound({x_first, kLowest, kLowest});
         it != of_submap.end() && it->first.x <= x_last; ++it) {
      if (touches(center.array(), it->first, it->first)) f(TileId{id, it->first}, it->second);
    }
  }
}

void TileMap::for_each_tile_near(
    const Eigen::Vector3d& center_local, double radius,
    const std::function<void(const TileId&, const TilePoints&)>& f) const {
  for_each_near(&Submap::tiles, center_local, radius,
                [&](const TileId& id, const Tile& tile) { f(id, *tile.points); });
}

TileChanges TileMap::take_changes() {
  TileChanges changes;
  for (std::size_t id = 0; id < submaps_.size(); ++id) {
    for (auto& [key, tile] : submaps_[id].tiles) {
      if (tile.has_changed()) changes.changed.push_back({{id, key}, tile.take_snapshot()});
    }
  }
  // One that went and came again is among the changed.
  std::erase_if(removed_,
                [&](const TileId& id) { return submaps_[id.submap].tiles.contains(id.key); });
  changes.removed = std::exchange(removed_, {});
  return changes;
}

void TileMap::drop_beyond(const Eigen::Vector3d& center_local, double radius) {
  std::set<TileId> near;
  for_each_near(&Submap::tiles, center_local, radius,
                [&](const TileId& id, const Tile&) { near.insert(id); });
  for (std::size_t id = 0; id + 1 < submaps_.size(); ++id) {
    Submap& submap = submaps_[id];
    std::erase_if(submap.tiles, [&](const auto& entry) {
      const auto& [key, tile] = entry;
      if (tile.has_changed() || near.contains({id, key})) return false;
      submap.stored.emplace(key, tile.points->size());
      size_in_memory_ -= tile.points->size();
      return true;
    });
  }
}

std::vector<TileId> TileMap::stored_near(const Eigen::Vector3d& center_local, double radius) const {
  std::vector<TileId> near;
  for_each_near(&Submap::stored, center_local, radius, [&](const TileId& id, std::size_t) {
    if (id.submap + 1 < submaps_.size()) near.push_back(id);
  });
  if (!submaps_.empty()) {
    for (const auto& [key, points] : submaps_.back().stored) {
      near.push_back({submaps_.size() - 1, key});
    }
  }
  return near;
}

void TileMap::declare_stored(const TileId& id, std::size_t points) {
  if (id.submap >= submaps_.size()) {
    throw std::logic_error(name_of(id) + ": the submap does not exist");
  }
  Submap& submap = submaps_[id.submap];
  if (submap.tiles.contains(id.key) || !submap.stored.emplace(id.key, points).second) {
    throw std::logic_error(name_of(id) + " is there already");
  }
  widen(submap, id.key);
  size_ += points;
}

void TileMap::restore(const TileId& id, TilePoints tile) {
  const auto submap = id.submap < submaps_.size() ? &submaps_[id.submap] : nullptr;
  const auto stored = submap ? submap->stored.find(id.key) : decltype(submap->stored.end()){};
  if (submap == nullptr || stored == submap->stored.end()) {
    throw std::logic_error(name_of(id) + " is not stored");
  }
  if (tile.origin != corner(id.key) || tile.size() != stored->second) {
    throw std::logic_error(name_of(id) + " comes back as another one");
  }
  tile.check();
  require_same_columns(!tile.intensity.empty());
  size_in_memory_ += tile.size();
  submap->stored.erase(stored);
  submap->tiles.emplace(id.key, Tile(std::move(tile)));
}

}  // namespace fovea
