// Keeps the tiles near the vehicle in memory. The map file has the others.
#pragma once

#include <cstddef>
#include <future>
#include <map>
#include <vector>

#include "fovea/map/checkpointer.h"
#include "fovea/map/tile_map.h"

namespace fovea {

/// The map of a file, with all tiles on disk.
/// @param tile_size  of the map, m
TileMap stored_map(const MapReader& reader, double tile_size);

/// Evicts tiles of a map that are out of reach, and loads them before the vehicle comes back.
class TileCache {
 public:
  /// @param file    must outlive the cache
  /// @param memory  bytes that the process should keep to: half of them are for tiles
  TileCache(Checkpointer& file, std::size_t memory);

  /// Loads all tiles that a ball touches, and those of the last submap. Requests tiles somewhat
  /// farther away, so that they are there when the vehicle arrives. InputError if the file is
  /// damaged; errors of writing as Checkpointer::wait().
  void load_within(TileMap& map, const Eigen::Vector3d& center_local, double radius);

  /// Evicts tiles well beyond a ball, but no tile of the last submap and no tile with changes that
  /// are not yet in the file. Waits for the latest checkpoint, and throws its error.
  void evict_beyond(TileMap& map, const Eigen::Vector3d& center_local, double radius);

  /// Whether the tiles take more memory than they should, and evict_beyond() may help.
  bool is_full(const TileMap& map) const;

 private:
  void request(const std::vector<TileId>& ids);

  Checkpointer& file_;
  std::size_t most_points_;                // in memory
  std::size_t points_after_eviction_ = 0;  // in memory, after the last one
  std::map<TileId, std::future<TilePoints>> requested_;
};

}  // namespace fovea
