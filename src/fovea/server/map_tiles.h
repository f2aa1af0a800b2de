// The tiles of one map's levels of detail.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "fovea/core/scratch_file.h"
#include "fovea/exporting/tileset/node_points.h"

namespace fovea {

/// A map file as 3D Tiles. Leaves are read from the map. The coarse levels, of which each point
/// stands for many, are made once and kept in a scratch file: memory does not grow with the map.
/// Thread-safe.
class MapTiles {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  /// InputError if the map cannot be read.
  MapTiles(const std::filesystem::path& map, const ExposureChoice& exposure);
  ~MapTiles();
  MapTiles(const MapTiles&) = delete;
  MapTiles& operator=(const MapTiles&) = delete;

  const TileNode& root() const { return root_; }
  /// nullptr if there is no node of that name.
  const TileNode* find(const std::string& name) const;
  std::size_t leaves() const { return leaves_; }

  // Tiles are binary glTF with where the points come from. InputError if the map is damaged.
  Bytes leaf(const TileNode& leaf);
  /// nullptr if the node has not been made.
  Bytes find_coarse(const TileNode& node);
  /// Makes a coarse node and all below it, one thread at a time.
  /// @param made  called with each node after it is there; may throw to stop
  void make_coarse(const TileNode& node, const std::function<void(const TileNode&)>& made);

 private:
  struct Reader;
  void index(const TileNode& node);
  std::unique_ptr<Reader> take_reader();
  void put_back(std::unique_ptr<Reader> reader);

  std::filesystem::path map_;
  PointChoice choice_;
  TileNode root_;
  std::unordered_map<std::string, const TileNode*> node_of_name_;
  std::size_t leaves_ = 0;

  std::mutex making_;
  std::mutex guard_;  // of what follows
  ScratchFile scratch_;
  std::unordered_map<std::string, ScratchFile::Place> coarse_;  // by name
  std::vector<std::unique_ptr<Reader>> idle_readers_;
};

}  // namespace fovea
