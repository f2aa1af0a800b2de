#include "fovea/map/map_keeper.h"

#include <algorithm>
#include <chrono>
#include <iterator>

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

void put(MapWriter& writer, const MapRows& rows, const std::vector<TileId>& removed) {
  for (const auto& [key, value] : rows.meta) writer.put_meta(key, value);
  for (std::size_t id = 0; id < rows.drives.size(); ++id) writer.put_drive(id, rows.drives[id]);
  for (std::size_t id = 0; id < rows.sensors.size(); ++id) writer.put_sensor(id, rows.sensors[id]);
  for (const FrameRecord& frame : rows.frames) writer.put_frame(frame);
  for (const auto& [frame, T_local_lidar] : rows.poses) writer.put_pose(frame, T_local_lidar);
  for (const auto& [id, T_local_submap] : rows.submaps) writer.put_submap(id, T_local_submap);
  for (const TileId& id : removed) writer.remove_tile(id);
}

/// Packs the tiles that have changed lately, whose handles are dropped: what the next frame changes
/// would have to be copied if the writer shared it.
std::vector<PackedTile> pack_lately_changed(std::vector<TileChanges::Changed>& tiles) {
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

PackedTile MapKeeper::Tiles::take(std::size_t i) {
  if (i < packed.size()) return std::move(packed[i]);
  TileChanges::Changed& tile = shared[i - packed.size()];
  PackedTile result = pack_tile(tile.id, *tile.points);
  tile.points = {};
  return result;
}

void MapKeeper::Tiles::drop(const std::set<TileId>& ids) {
  const auto is_one = [&](const auto& tile) { return ids.contains(tile.id); };
  std::erase_if(packed, is_one);
  std::erase_if(shared, is_one);
}

void MapKeeper::Tiles::drop_first(std::size_t count) {
  const std::size_t of_packed = std::min(count, packed.size());
  packed.erase(packed.begin(), packed.begin() + std::ptrdiff_t(of_packed));
  shared.erase(shared.begin(), shared.begin() + std::ptrdiff_t(count - of_packed));
}

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
    requested_.emplace(id, worker_.post([this, id, is_ended = ended_.get_token()] {
      return is_ended.stop_requested() ? TilePoints() : writer_->read_tile(id);
    }));
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

MapKeeper::Tiles MapKeeper::take_over_checkpoint() {
  taken_over_.request_stop();
  hurry_.request_stop();
  return written_.valid() ? written_.get() : Tiles();
}

TileChanges MapKeeper::take_changes(TileMap& map, const MapRows& rows) {
  TileChanges changes = map.take_changes();
  if (on_checkpoint_) on_checkpoint_(changes, rows);
  return changes;
}

void MapKeeper::write(MapRows rows, std::vector<TileId> removed, Tiles tiles) {
  hurry_ = std::stop_source();
  taken_over_ = std::stop_source();
  written_ = worker_.post([this, rows = std::move(rows), removed = std::move(removed),
                           tiles = std::move(tiles), hurry = hurry_.get_token(),
                           taken_over = taken_over_.get_token()]() mutable {
    const WallClock::time_point latest = WallClock::now() + kPatience;
    put(*writer_, rows, removed);
    std::size_t next = 0;
    while (next < tiles.size() && !hurry.stop_requested()) {
      pause_(latest, hurry);
      writer_->put_tile(tiles.take(next++));
    }
    if (taken_over.stop_requested()) {
      tiles.drop_first(next);
      return std::move(tiles);
    }
    // Who waits lets the rest have all processors.
    writer_->put_tiles(tiles.size() - next, [&](std::size_t i) { return tiles.take(next + i); });
    if (!commit_at_end_) writer_->commit();
    if (resident_memory() > memory_ - memory_ / 4) release_free_memory();
    return Tiles();
  });
}

void MapKeeper::checkpoint(TileMap& map, MapRows rows, const Eigen::Vector3d& center_local,
                           double radius) {
  end_checkpoint();
  TileChanges changes = take_changes(map, rows);
  std::vector<PackedTile> packed = pack_lately_changed(changes.changed);
  write(std::move(rows), std::move(changes.removed),
        {std::move(packed), std::move(changes.changed)});
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
  ended_.request_stop();  // a tile requested ahead may lie in a checkpoint that is taken over
  Tiles tiles;
  if (on_checkpoint_) {
    end_checkpoint();
  } else {
    tiles = take_over_checkpoint();
  }
  TileChanges changes = take_changes(map, rows);
  std::set<TileId> newer(changes.removed.begin(), changes.removed.end());
  for (const TileChanges::Changed& tile : changes.changed) newer.insert(tile.id);
  tiles.drop(newer);
  std::move(changes.changed.begin(), changes.changed.end(), std::back_inserter(tiles.shared));
  // No frame is to come any more: all processors are the writer's.
  worker_
      .post([&] {
        put(*writer_, rows, changes.removed);
        writer_->put_tiles(tiles.size(), [&](std::size_t i) { return tiles.take(i); });
        writer_->finish();
      })
      .get();
}

}  // namespace fovea
