#include "fovea/map/tile_cache.h"

#include <algorithm>
#include <chrono>

namespace fovea {
namespace {

/// Distances beyond the ball at which tiles are requested and evicted, m. The first is a second or
/// two of drive, in which the disk answers. The second is larger, so that a vehicle that turns on
/// the spot loads no tile twice.
constexpr double kRequestedBeyond = 20, kEvictedBeyond = 30;

/// Of a tile in memory: 23 in columns, and the allocator's rounding.
constexpr std::size_t kBytesPerPoint = 26;

}  // namespace

TileMap stored_map(const MapReader& reader, double tile_size) {
  TileMap map(tile_size);
  for (const RigidMotion& T_local_submap : reader.submaps()) map.add_submap(T_local_submap);
  for (const auto& [id, points] : reader.tile_sizes()) map.declare_stored(id, points);
  return map;
}

TileCache::TileCache(Checkpointer& file, std::size_t memory)
    : file_(file), most_points_(memory / 2 / kBytesPerPoint) {}

void TileCache::request(const std::vector<TileId>& ids) {
  for (const TileId& id : ids) {
    if (!requested_.contains(id)) requested_.emplace(id, file_.read_tile(id));
  }
}

void TileCache::load_within(TileMap& map, const Eigen::Vector3d& center_local, double radius) {
  const std::vector<TileId> needed = map.stored_near(center_local, radius);
  request(needed);
  request(map.stored_near(center_local, radius + kRequestedBeyond));
  for (const TileId& id : needed) requested_.at(id).wait();
  for (auto request = requested_.begin(); request != requested_.end();) {
    auto& [id, tile] = *request;
    if (tile.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
      map.restore(id, tile.get());
      request = requested_.erase(request);
    } else {
      ++request;
    }
  }
}

void TileCache::evict_beyond(TileMap& map, const Eigen::Vector3d& center_local, double radius) {
  file_.wait();
  map.drop_beyond(center_local, radius + (is_full(map) ? kRequestedBeyond : kEvictedBeyond));
  points_after_eviction_ = map.size_in_memory();
}

bool TileCache::is_full(const TileMap& map) const {
  // Tiles in reach stay, also if they need more memory than most_points_.
  return map.size_in_memory() >
         std::max(most_points_, points_after_eviction_ + points_after_eviction_ / 4);
}

}  // namespace fovea
