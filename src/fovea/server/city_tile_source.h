// The tiles of a city's levels of detail, made when they are requested.
#pragma once

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "fovea/core/scratch_file.h"
#include "fovea/exporting/city/city_tree.h"
#include "fovea/server/job_queue.h"
#include "fovea/server/map_tiles.h"
#include "fovea/server/site_content.h"

namespace fovea {

/// The levels of detail of a city (docs/viewer-protocol.md):
///
///   tileset.json      the quadtree over the tiles
///   q/NAME.glb        points of a node of the quadtree: made of the coarse levels of the tiles'
///                     overviews
///   q/NAME.json       a part of the quadtree of a large city
///   X_Y/overview.glb  a tile's coarsest level: the file of 'fovea fuse', or made of the map
///   X_Y/tileset.json  a tile's finer levels, X_Y/NAME.glb
///
/// The maps of the eight tiles that were requested last are open.
class CityTileSource : public SiteContent {
 public:
  /// @param city      outlives the source
  /// @param exposure  of the colors
  /// @param jobs      outlives all requests
  CityTileSource(const City& city, const ExposureChoice& exposure, JobQueue& jobs);
  ~CityTileSource() override;

  void request(const std::string& path, Receiver receiver) override;
  /// A line for each tile that could not be read so far.
  std::string failure() const;

 private:
  /// nullptr if there is no file of that name.
  Bytes make(const std::string& path);
  Bytes make_of_tree(const std::string& name, const std::string& ending);
  Bytes make_of_tile(std::size_t tile, const std::string& name, const std::string& ending);
  Bytes node_content(const CityNode& node);
  std::vector<ExportPoint> points_for_node(std::size_t tile, const CityNode& node);
  Bytes overview(std::size_t tile);
  bool has_overview_file(std::size_t tile) const;
  bool files_have_exposure() const;
  std::shared_ptr<MapTiles> open_tile(std::size_t tile);

  CityTileShape shape(std::size_t tile);
  CityTileShape guessed_shape() const;
  std::string tree_json(const CityNode& root, const std::string& to_tiles,
                        const std::string& to_nodes) const;
  void index(const CityNode& node);

  Bytes find_cached(const std::string& path) const;
  void cache(const std::string& path, const std::string& bytes);
  void note_failure(std::size_t tile, const std::string& failure);
  std::string tile_name(std::size_t tile) const;

  const City& city_;
  ExposureChoice exposure_;
  JobQueue& jobs_;
  CityNode root_;
  std::unordered_map<std::string, const CityNode*> node_of_name_;
  std::unordered_map<std::string, std::size_t> tile_of_name_;

  std::mutex making_nodes_, opening_;
  mutable std::mutex guard_;  // of what follows
  ScratchFile scratch_;
  std::unordered_map<std::string, ScratchFile::Place> cached_;           // by path
  std::list<std::pair<std::size_t, std::shared_ptr<MapTiles>>> opened_;  // the latest first
  std::map<std::size_t, std::string> failures_;                          // by the tile's number
};

}  // namespace fovea
