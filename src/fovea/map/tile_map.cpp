#include "fovea/map/tile_map.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "fovea/base/parallel.h"

namespace fovea {
namespace {

/// Stored floats may round to just outside their tile; relative to the tile's edge.
constexpr double kRoundingMargin = 1e-6;
constexpr std::size_t kGrain = 8192;

std::int32_t tile_index(double tiles) {
  const double index = std::floor(tiles);
  // Written so that NaN fails too.
  if (!(index >= std::numeric_limits<std::int32_t>::min() &&
        index <= std::numeric_limits<std::int32_t>::max())) {
    throw std::invalid_argument(fmt::format(
        "a point lies {} tiles from its submap's origin: not finite or too far", tiles));
  }
  return static_cast<std::int32_t>(index);
}

TileKey key_of(const Eigen::Vector3d& p_submap, double tile_size) {
  const Eigen::Vector3d tiles = p_submap / tile_size;
  return {tile_index(tiles.x()), tile_index(tiles.y()), tile_index(tiles.z())};
}

/// Appends the chosen points, positions apart, to a tile.
void append_columns(const PointCloud& points, const std::vector<std::uint32_t>& indices,
                    PointCloud& tile) {
  const auto gather = [&](const auto& from, auto& to) {
    std::size_t next = to.size();
    to.resize(next + indices.size());
    for (const std::uint32_t i : indices) to[next++] = from[i];
  };
  gather(points.range, tile.range);
  gather(points.incidence, tile.incidence);
  gather(points.color, tile.color);
  gather(points.frame, tile.frame);
  gather(points.camera, tile.camera);
  gather(points.interpolated, tile.interpolated);
  gather(points.views, tile.views);
  gather(points.spread, tile.spread);
  gather(points.weight, tile.weight);
  gather(points.reason, tile.reason);
  if (!points.intensity.empty()) gather(points.intensity, tile.intensity);
}

/// Indices of tiles that [low, high] m may touch, clamped to what a key can hold.
std::pair<std::int32_t, std::int32_t> index_range(double low, double high, double tile_size) {
  constexpr double kMin = std::numeric_limits<std::int32_t>::min();
  constexpr double kMax = std::numeric_limits<std::int32_t>::max();
  return {static_cast<std::int32_t>(std::clamp(std::floor(low / tile_size), kMin, kMax)),
          static_cast<std::int32_t>(std::clamp(std::floor(high / tile_size), kMin, kMax))};
}

}  // namespace

void check_tile_columns(const PointCloud& cloud) {
  cloud.check();
  if (cloud.empty()) return;
  const auto require = [](const char* name, const auto& column) {
    if (column.empty()) {
      throw std::logic_error(fmt::format("points of a map must have the column '{}'", name));
    }
  };
  require("range", cloud.range);
  require("incidence", cloud.incidence);
  require("color", cloud.color);
  require("frame", cloud.frame);
  require("camera", cloud.camera);
  require("interpolated", cloud.interpolated);
  require("views", cloud.views);
  require("spread", cloud.spread);
  require("weight", cloud.weight);
  require("reason", cloud.reason);
}

TileMap::TileMap(double tile_size) : tile_size_(tile_size) {
  if (!(tile_size > 0) || !std::isfinite(tile_size)) {
    throw std::invalid_argument(fmt::format("tile size {} m is not positive", tile_size));
  }
}

Eigen::Vector3d TileMap::corner(const TileKey& key) const {
  return Eigen::Vector3d(key.x, key.y, key.z) * tile_size_;
}

void TileMap::require_same_columns(const PointCloud& cloud) {
  check_tile_columns(cloud);
  const bool has_intensity = !cloud.intensity.empty();
  if (has_intensity_.value_or(has_intensity) != has_intensity) {
    throw std::logic_error("only some points of the map have the column 'intensity'");
  }
  has_intensity_ = has_intensity;
}

void TileMap::add_submap(const RigidMotion& T_local_submap) {
  if (!T_local_submap.matrix().allFinite()) {
    throw std::invalid_argument("the pose of a submap is not finite");
  }
  submaps_.push_back({T_local_submap, {}});
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

std::vector<TileKey> TileMap::add(const PointCloud& points_local) {
  if (submaps_.empty()) throw std::logic_error("points need a submap to be added to");
  if (points_local.empty()) return {};
  require_same_columns(points_local);
  Submap& submap = submaps_.back();

  const RigidMotion T_submap_local = submap.T_local_submap.inverse();
  const Eigen::Matrix3d R = T_submap_local.linear();
  const Eigen::Vector3d t = T_submap_local * points_local.origin;
  std::vector<Eigen::Vector3d> p_submap(points_local.size());
  std::vector<TileKey> keys(p_submap.size());
  parallel_for(p_submap.size(), kGrain, [&](std::size_t i) {
    p_submap[i] = R * points_local.position[i].cast<double>() + t;
    keys[i] = key_of(p_submap[i], tile_size_);
  });
  std::map<TileKey, std::vector<std::uint32_t>> groups;
  auto group = groups.end();  // neighbours in a cloud mostly share a tile
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (group == groups.end() || group->first != keys[i]) group = groups.try_emplace(keys[i]).first;
    group->second.push_back(static_cast<std::uint32_t>(i));
  }

  std::vector<TileKey> grown;
  std::vector<std::pair<PointCloud*, const std::vector<std::uint32_t>*>> additions;
  for (const auto& [key, indices] : groups) {
    PointCloud& tile = submap.tiles[key];
    tile.origin = corner(key);
    additions.emplace_back(&tile, &indices);
    grown.push_back(key);
  }
  parallel_for(additions.size(), 1, [&](std::size_t k) {
    const auto& [tile, indices] = additions[k];
    append_columns(points_local, *indices, *tile);
    std::size_t next = tile->position.size();
    tile->position.resize(next + indices->size());
    for (const std::uint32_t i : *indices) {
      tile->position[next++] = (p_submap[i] - tile->origin).cast<float>();
    }
  });
  size_ += points_local.size();
  return grown;
}

void TileMap::restore_tile(std::size_t submap, const TileKey& key, PointCloud tile) {
  if (submap >= submaps_.size()) {
    throw std::logic_error(fmt::format("submap {} of a restored tile does not exist", submap));
  }
  if (submaps_[submap].tiles.contains(key)) {
    throw std::logic_error(
        fmt::format("tile {} {} {} of submap {} is there already", key.x, key.y, key.z, submap));
  }
  if (tile.origin != corner(key)) {
    throw std::logic_error(fmt::format("tile {} {} {} of submap {} has another tile size", key.x,
                                       key.y, key.z, submap));
  }
  if (tile.empty()) return;
  require_same_columns(tile);
  tile.normal.clear();
  size_ += tile.size();
  submaps_[submap].tiles.emplace(key, std::move(tile));
}

PointCloud& TileMap::existing_tile(const TileId& id) {
  if (id.submap < submaps_.size()) {
    const auto found = submaps_[id.submap].tiles.find(id.key);
    if (found != submaps_[id.submap].tiles.end()) return found->second;
  }
  throw std::logic_error(fmt::format("tile {} {} {} of submap {} does not exist", id.key.x,
                                     id.key.y, id.key.z, id.submap));
}

void TileMap::keep_points(const TileId& id, const std::vector<std::uint32_t>& indices) {
  PointCloud& tile = existing_tile(id);
  size_ -= tile.size() - indices.size();
  if (indices.empty()) {
    submaps_[id.submap].tiles.erase(id.key);
  } else {
    tile.keep(indices);
  }
}

TileColors TileMap::colors(const TileId& id) {
  PointCloud& tile = existing_tile(id);
  return {tile.color, tile.views, tile.spread, tile.weight};
}

void TileMap::for_each_tile_near(
    const Eigen::Vector3d& center_local, double radius,
    const std::function<void(const TileId&, const PointCloud&)>& f) const {
  const double reach = radius + kRoundingMargin * tile_size_;
  if (!(reach >= 0)) return;
  constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
  for (std::size_t id = 0; id < submaps_.size(); ++id) {
    const Submap& submap = submaps_[id];
    const Eigen::Vector3d center = submap.T_local_submap.inverse() * center_local;
    const auto [x_first, x_last] = index_range(center.x() - reach, center.x() + reach, tile_size_);
    for (auto it = submap.tiles.lower_bound({x_first, kLowest, kLowest});
         it != submap.tiles.end() && it->first.x <= x_last; ++it) {
      const Eigen::Array3d low = corner(it->first).array();
      const Eigen::Array3d nearest = center.array().max(low).min(low + tile_size_);
      if ((nearest - center.array()).matrix().squaredNorm() <= reach * reach) {
        f({id, it->first}, it->second);
      }
    }
  }
}

}  // namespace fovea
