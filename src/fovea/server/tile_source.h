// The tiles of a map's levels of detail, made when they are asked for.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "fovea/core/scratch_file.h"
#include "fovea/exporting/tileset/node_points.h"

namespace fovea {

/// A map file as 3D Tiles. Leaves are read from the map on request; the coarser levels, of which
/// each point stands for many, are made once, in the background from the opening on, and kept in a
/// scratch file: memory does not grow with the map.
class TileSource {
 public:
  using Bytes = std::shared_ptr<const std::string>;
  /// Receives a tile, nullptr if there is none of that name, or what went wrong instead.
  using Receiver = std::function<void(Bytes tile, const std::string& error)>;

  /// InputError if the map cannot be read.
  explicit TileSource(const std::filesystem::path& map, const ExposureChoice& exposure = {});
  /// Drops the receivers that still wait.
  ~TileSource();
  TileSource(const TileSource&) = delete;
  TileSource& operator=(const TileSource&) = delete;

  /// tileset.json, of the local frame; a tile's address there is its name and ".glb".
  Bytes tileset() const { return tileset_; }
  /// A tile as binary glTF with where its points come from. `receiver` is called once: at once, or
  /// by another thread when the tile has been made. From any thread.
  void request(const std::string& name, Receiver receiver);
  /// How much of the map has been read for the coarse levels, 0 to 1; 1 when they are there.
  double read() const;
  /// Why they cannot be made; empty while nothing is wrong.
  std::string failure() const;

 private:
  struct Reader;
  void index(const TileNode& node);
  void make_coarse_levels(const std::stop_token& stop);
  void keep(const TileNode& node, const std::vector<ExportPoint>& points);
  Bytes read_coarse(const ScratchFile::Place& place);
  Bytes make_leaf(const TileNode& leaf);

  std::filesystem::path map_;
  PointChoice choice_;
  TileNode root_;
  std::unordered_map<std::string, const TileNode*> node_of_name_;
  std::size_t leaves_ = 0;
  Bytes tileset_;

  mutable std::mutex guard_;  // of what follows
  ScratchFile scratch_;
  std::unordered_map<std::string, ScratchFile::Place> coarse_;  // by name
  std::unordered_map<std::string, std::vector<Receiver>> waiting_;
  std::vector<std::unique_ptr<Reader>> idle_readers_;
  std::string failure_;

  std::atomic<std::size_t> leaves_read_{0};
  std::jthread maker_;  // last: uses all of the above
};

}  // namespace fovea
