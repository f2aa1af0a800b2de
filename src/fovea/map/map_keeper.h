// The map of a run that goes on, in its file: what changed is written from a thread of its own,
// what is out of reach is dropped from memory and read again when it comes near.
#pragma once

#include <functional>
#include <future>
#include <map>
#include <memory>
#include <set>
#include <stop_token>
#include <utility>
#include <vector>

#include "fovea/base/wall_clock.h"
#include "fovea/base/worker.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/map_store.h"
#include "fovea/map/packed_tile.h"
#include "fovea/map/tile_map.h"

namespace fovea {

/// What a checkpoint writes besides tiles.
struct MapRows {
  MapMeta meta;
  std::vector<DriveRecord> drives;    ///< by number; empty: as they were
  std::vector<SensorRecord> sensors;  ///< by number; empty: as they were
  std::vector<FrameRecord> frames;
  std::vector<std::pair<int, RigidMotion>> poses;  ///< T_local_lidar of frames written before
  std::vector<std::pair<std::size_t, RigidMotion>> submaps;  ///< T_local_submap
};

struct MapKeeperOptions {
  bool threaded = true;  ///< false: all is done by whoever asks for it
  /// Bytes that the process should keep to: half of them are the tiles'.
  std::size_t memory = std::size_t{1} << 30;
  /// Nothing is committed before finish(): for a map that is of use only when whole.
  bool commit_at_end = false;
  /// Told what a checkpoint is going to write, by whoever asks for it, when the one before is
  /// committed.
  std::function<void(const TileChanges&, const MapRows&)> on_checkpoint = {};
  /// Called by the thread that writes before each tile, until `hurry` is asked for. It may wait for
  /// a better moment, but not beyond `latest` nor once that is.
  using Pause = std::function<void(WallClock::time_point latest, const std::stop_token& hurry)>;
  Pause pause = [](WallClock::time_point, const std::stop_token&) {};
};

/// What a file has of a map; all tiles stay there until they are needed.
/// @param tile_size  of the map, m
TileMap stored_map(const MapReader& reader, double tile_size);

/// Each checkpoint is one transaction: after a crash the file has the state of the last that was
/// committed, whole; unless all is to be committed at the end. Whether and when one is made never
/// changes the map that comes out.
class MapKeeper {
 public:
  MapKeeper(std::unique_ptr<MapWriter> writer, const MapKeeperOptions& options);
  /// Waits for the checkpoint that was begun: whatever ends the run, what it was given is kept.
  ~MapKeeper();

  /// Begins a step of the map with all tiles that a ball touches in memory, and those of the last
  /// submap, and sees to it that those somewhat beyond come. InputError if the file has been
  /// damaged meanwhile.
  void bring_near(TileMap& map, const Eigen::Vector3d& center_local, double radius);

  /// Begins to write what has changed since the last one, and returns: tiles that changed lately
  /// are packed first, others are shared until they are written. Drops from memory what lies well
  /// beyond the ball, but no tile of the last submap. Waits for the checkpoint before. OutputError
  /// of an earlier one, e.g. of a full disk.
  void checkpoint(TileMap& map, MapRows rows, const Eigen::Vector3d& center_local, double radius);

  /// Whether a checkpoint would have to wait.
  bool is_writing() const;

  /// Whether the tiles in memory take more than they should and a checkpoint would drop some.
  bool needs_memory(const TileMap& map) const;

  /// Waits until all checkpoints are written and committed.
  void finish();
  /// The last checkpoint, of a map that changes no more: finish() with what has changed, and
  /// MapWriter::finish(). A checkpoint that is still being written becomes part of it, unless
  /// `on_checkpoint` reports each one.
  void finish(TileMap& map, MapRows rows);

 private:
  /// Tiles to be written: those that may change meanwhile are packed.
  struct Tiles {
    std::vector<PackedTile> packed;
    std::vector<TileChanges::Changed> shared;
    std::size_t size() const { return packed.size() + shared.size(); }
    /// Of all, packed. The map need not copy it any more when it changes it.
    PackedTile take(std::size_t i);
    void drop(const std::set<TileId>& ids);
    void drop_first(std::size_t count);
  };
  /// Waits for the latest checkpoint, which need not be patient any more. Its error comes out here.
  void end_checkpoint();
  /// As end_checkpoint(), but what the checkpoint has not yet begun to write is left to the caller,
  /// and so is its commit.
  Tiles take_over_checkpoint();
  TileChanges take_changes(TileMap& map, const MapRows& rows);
  void write(MapRows rows, std::vector<TileId> removed, Tiles tiles);

  std::size_t memory_;       // bytes that the process should keep to
  std::size_t most_points_;  // in memory
  bool commit_at_end_;
  std::function<void(const TileChanges&, const MapRows&)> on_checkpoint_;
  MapKeeperOptions::Pause pause_;
  std::size_t undroppable_ = 0;        // points that stayed there at the last checkpoint
  std::unique_ptr<MapWriter> writer_;  // the worker's, once there is one
  std::future<Tiles> written_;         // what the latest checkpoint has left to others
  std::stop_source hurry_;             // for it
  std::stop_source taken_over_;        // it is to leave what it has not begun
  std::stop_source ended_;             // no frame follows: requested tiles are not needed
  std::map<TileId, std::future<TilePoints>> requested_;
  Worker worker_;
};

}  // namespace fovea
