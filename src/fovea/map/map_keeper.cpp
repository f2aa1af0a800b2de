#include "fovea/map/map_keeper.h"

#include <algorithm>
#include <chrono>

#include "fovea/base/give_way.h"
#include "fovea/base/parallel.h"
#include "fovea/base/process_memory.h"

namespace fovea {
namespace {

/// Tiles are asked for so far before they are needed, and dropped so far beyond: a second or two of
/// drive, in which the disk answers, and a vehicle that turns on the spot moves none of them twice.
constexpr double kAhead = 20, kBeyond = 30;  // m

/// Of a tile in memory: 23 of columns, and what the allocator rounds up.
constexpr std::size_t kBytesPerPoint = 26;

/// What is written can wait, a frame cannot: the processor is left to the frame while it lasts.
/// What is read is waited for, but seldom, and by threads that leave the processor meanwhile.
constexpr int kNice = 15;

/// A checkpoint may take so long to wait for moments in which no frame is under way.
constexpr std::chrono::seconds kPatience{1};

template <class T>
bool is_ready(const std::future<T>& result) {
  return result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void put(MapWriter& writer, const MapRows& rows, const TileChanges& tiles) {
  for (const auto& [key, value] : rows.meta) writer.put_meta(key, value);
  for (const FrameRecord& frame : rows.frames) writer.put_frame(frame);
  for (const auto& [frame, T_local_lidar] : rows.poses) writer.put_pose(frame, T_local_lidar);
  for (const auto& [id, T_local_submap] : rows.submaps) writer.put_submap(id, T_local_submap);
  for (const TileId& id : tiles.removed) writer.remove_tile(id);
}

/// Packs the tiles that have changed lately, whose handles are dropped: what the next frame changes
/// would have to be copied if the writer shared it.
std::vector<PackedTile> pack_lately_changed(TileChanges& changes) {
  auto& tiles = changes.changed;
  const auto first = std::stable_partition(
      tiles.begin(), tiles.end(), [](const TileChanges::Changed& tile) { return !tile.lately; });
  std::vector<PackedTile> packed(std::size_t(tiles.end() - first));
  parallel_for(packed.size(), 1, [&](std::size_t i) {
    const TileChanges::Changed& tile = first[std::ptrdiff_t(i)];
    packed[i] = pack_tile(tile.id, *tile.points);
  });
  tiles.erase(first, tiles.end());
  return packed;
}

}  // namespace

TileMap stored_map(const MapReader& reader, double tile_size) {
  TileMap map(tile_size);
  for (const RigidMotion& T_local_submap : reader.submaps()) map.add_submap(T_local_submap);
  for (const auto& [id, points] : reader.tile_sizes()) map.declare_stored(id, points);
  return map;
}

MapKeeper::MapKeeper(std::unique_ptr<MapWriter> writer, const MapKeeperOptions& options)
    : memory_(options.memory),
      most_points_(options.memory / 2 / kBytesPerPoint),
      commit_at_end_(options.commit_at_end),
      on_checkpoint_(options.on_checkpoint),
      pause_(options.pause),
      writer_(std::move(writer)),
      worker_(options.threaded) {
  if (options.threaded) worker_.post([] { give_way(kNice); });
}

MapKeeper::~MapKeeper() {
  hurry_.request_stop();
  if (written_.valid()) written_.wait();
}

void MapKeeper::end_checkpoint() {
  hurry_.request_stop();
  if (written_.valid()) written_.get();
}

void MapKeeper::bring_near(TileMap& map, const Eigen::Vector3d& center_local, double radius) {
  map.begin_step();
  for (const TileId& id : map.stored_near(center_local, radius + kAhead)) {
    if (requested_.contains(id)) continue;
    requested_.emplace(id, worker_.post([this, id] { return writer_->read_tile(id); }));
  }
  for (const TileId& id : map.stored_near(center_local, radius)) {
    const std::future<TilePoints>& tile = requested_.at(id);
    if (is_ready(tile)) continue;
    hurry_.request_stop();  // the worker may have a checkpoint to write first
    tile.wait();
  }
  for (auto entry = requested_.begin(); entry != requested_.end();) {
    auto& [id, tile] = *entry;
    if (is_ready(tile)) {
      map.restore(id, tile.get());
      entry = requested_.erase(entry);
    } else {
      ++entry;
    }
  }
}

bool MapKeeper::is_writing() const { return written_.valid() && !is_ready(written_); }

TileChanges MapKeeper::take_changes(TileMap& map, const MapRows& rows) {
  end_checkpoint();
  TileChanges changes = map.take_changes();
  if (on_checkpoint_) on_checkpoint_(changes, rows);
  return changes;
}

void MapKeeper::write(MapRows rows, std::vector<PackedTile> packed, TileChanges shared) {
  hurry_ = std::stop_source();
  written_ = worker_.post([this, rows = std::move(rows), packed = std::move(packed),
                           shared = std::move(shared), hurry = hurry_.get_token()]() mutable {
    const WallClock::time_point latest = WallClock::now() + kPatience;
    put(*writer_, rows, shared);
    const std::size_t count = packed.size() + shared.changed.size();
    const auto take = [&](std::size_t i) {
      if (i < packed.size()) return std::move(packed[i]);
      TileChanges::Changed& tile = shared.changed[i - packed.size()];
      PackedTile result = pack_tile(tile.id, *tile.points);
      tile.points = {};  // the map need not copy it any more when it changes it
      return result;
    };
    std::size_t next = 0;
    while (next < count && !hurry.stop_requested()) {
      pause_(latest, hurry);
      writer_->put_tile(take(next++));
    }
    // Who waits lets the rest have all processors.
    writer_->put_tiles(count - next, [&](std::size_t i) { return take(next + i); });
    if (!commit_at_end_) writer_->commit();
    if (resident_memory() > memory_ - memory_ / 4) release_free_memory();
  });
}

void MapKeeper::checkpoint(TileMap& map, MapRows rows, const Eigen::Vector3d& center_local,
                           double radius) {
  TileChanges changes = take_changes(map, rows);
  std::vector<PackedTile> packed = pack_lately_changed(changes);
  write(std::move(rows), std::move(packed), std::move(changes));
  map.drop_beyond(center_local, radius + (needs_memory(map) ? kAhead : kBeyond));
  undroppable_ = map.size_in_memory();
}

bool MapKeeper::needs_memory(const TileMap& map) const {
  // What is in reach stays, however much it is: trying again each frame would not help.
  return map.size_in_memory() > std::max(most_points_, undroppable_ + undroppable_ / 4);
}

void MapKeeper::finish() {
  end_checkpoint();
  if (commit_at_end_) worker_.post([this] { writer_->commit(); }).get();
}

void MapKeeper::finish(TileMap& map, MapRows rows) {
  const TileChanges changes = take_changes(map, rows);
  // No frame is to come any more: all processors are the writer's.
  worker_
      .post([&] {
        put(*writer_, rows, changes);
        writer_->put_tiles(changes.changed.size(), [&](std::size_t i) {
          const TileChanges::Changed& tile = changes.changed[i];
          return pack_tile(tile.id, *tile.points);
        });
        writer_->commit();
      })
      .get();
}

}  // namespace fovea
