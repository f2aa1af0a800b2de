// The tiles of a map's levels of detail, made when they are requested.
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "fovea/server/map_tiles.h"
#include "fovea/server/site_content.h"

namespace fovea {

/// The levels of detail of one map: "tileset.json" and NAME.glb. One thread makes the coarse levels
/// from the opening on.
class TileSource : public SiteContent {
 public:
  /// InputError if the map cannot be read.
  explicit TileSource(const std::filesystem::path& map, const ExposureChoice& exposure = {});
  /// Drops the receivers that still wait.
  ~TileSource() override;
  TileSource(const TileSource&) = delete;
  TileSource& operator=(const TileSource&) = delete;

  void request(const std::string& path, Receiver receiver) override;
  /// How much of the map has been read for the coarse levels, 0 to 1; 1 when they are there.
  double read() const;
  /// Why they cannot be made; empty while nothing is wrong.
  std::string failure() const;

 private:
  void make_coarse_levels(const std::stop_token& stop);
  void deliver(const TileNode& node);
  void fail(const std::string& failure);

  MapTiles tiles_;
  Bytes tileset_;  // of the local frame

  mutable std::mutex guard_;  // of what follows
  std::unordered_map<std::string, std::vector<Receiver>> waiting_;
  std::string failure_;

  std::atomic<std::size_t> leaves_read_{0};
  std::jthread maker_;  // last: uses all of the above
};

}  // namespace fovea
