#include "fovea/map/checkpointer.h"

#include <chrono>
#include <deque>
#include <limits>
#include <map>
#include <stdexcept>

#include "fovea/core/process_memory.h"
#include "fovea/core/thread.h"
#include "fovea/map/packed_tile.h"

namespace fovea {
namespace {

/// checkpoint() never waits for room: the queue has one checkpoint at most, since the next one
/// waits for it.
constexpr std::size_t kQueued = std::numeric_limits<std::size_t>::max();

}  // namespace

Checkpointer::Checkpointer(std::unique_ptr<MapWriter> writer, const CheckpointerOptions& options)
    : options_(options), writer_(std::move(writer)), tasks_(kQueued) {
  if (!options_.threaded) return;
  const auto perform_all = [this](const std::stop_token&) {
    while (std::optional<Task> task = tasks_.pop()) perform(*task);
  };
  thread_ = start_thread("fovea-write", perform_all, ThreadPriority::kBackground);
}

Checkpointer::~Checkpointer() { tasks_.close(); }

void Checkpointer::queue(Task task) {
  if (!options_.threaded) return perform(task);
  if (!tasks_.push(std::move(task))) throw std::logic_error("a map is written on after its end");
}

TileChanges Checkpointer::take_changes(TileMap& map, const MapRows& rows) const {
  TileChanges changes = map.take_changes();
  if (options_.on_checkpoint) options_.on_checkpoint(changes, rows);
  return changes;
}

void Checkpointer::checkpoint(TileMap& map, MapRows rows) {
  wait();
  TileChanges changes = take_changes(map, rows);
  queue(ChangedRows{std::move(rows), std::move(changes.removed)});
  for (TileSnapshot& tile : changes.changed) queue(std::move(tile));
  Commit commit;
  written_ = commit.done.get_future();
  queue(std::move(commit));
}

bool Checkpointer::is_writing() const {
  return written_.valid() &&
         written_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

void Checkpointer::wait() {
  if (written_.valid()) written_.get();
}

std::future<TilePoints> Checkpointer::read_tile(const TileId& id) {
  TileRead read{id, {}};
  std::future<TilePoints> points = read.points.get_future();
  if (!options_.threaded) {
    queue(std::move(read));
  } else if (!tasks_.push_urgent(std::move(read))) {
    throw std::logic_error("a map is read after its end");
  }
  return points;
}

void Checkpointer::finish(TileMap& map, MapRows rows) {
  if (options_.on_checkpoint) wait();
  std::deque<Task> unwritten = tasks_.close_and_take();
  if (thread_.joinable()) thread_.join();  // from here on the caller uses writer_
  if (error_) std::rethrow_exception(error_);
  TileChanges changes = take_changes(map, rows);
  // The newest snapshot of each tile. The latest checkpoint becomes part of this one.
  std::map<TileId, std::shared_ptr<const TilePoints>> newest;
  for (Task& task : unwritten) {
    if (const auto* changed = std::get_if<ChangedRows>(&task)) write(*changed);
    if (auto* tile = std::get_if<TileSnapshot>(&task)) newest[tile->id] = std::move(tile->points);
  }
  for (const TileId& id : changes.removed) newest.erase(id);
  for (TileSnapshot& tile : changes.changed) newest[tile.id] = std::move(tile.points);
  write({std::move(rows), std::move(changes.removed)});
  std::vector<TileSnapshot> tiles;
  tiles.reserve(newest.size());
  for (auto& [id, points] : newest) tiles.push_back({id, std::move(points)});
  newest.clear();
  writer_->put_tiles(tiles.size(), [&](std::size_t i) {
    const TileSnapshot tile = std::move(tiles[i]);
    return pack_tile(tile.id, *tile.points);
  });
  writer_->finish();
}

void Checkpointer::write(const ChangedRows& changed) {
  const MapRows& rows = changed.rows;
  for (const auto& [key, value] : rows.meta) writer_->put_meta(key, value);
  for (std::size_t id = 0; id < rows.drives.size(); ++id) writer_->put_drive(id, rows.drives[id]);
  for (std::size_t id = 0; id < rows.sensors.size(); ++id) {
    writer_->put_sensor(id, rows.sensors[id]);
  }
  for (const FrameRecord& frame : rows.frames) writer_->put_frame(frame);
  for (const KeyframeRecord& keyframe : rows.keyframes) writer_->put_keyframe(keyframe);
  for (const auto& [frame, T_local_lidar] : rows.poses) writer_->put_pose(frame, T_local_lidar);
  for (const auto& [id, submap] : rows.submaps) writer_->put_submap(id, submap);
  for (const auto& [name, state] : rows.states) writer_->put_checkpoint(name, state);
  for (const TileId& id : changed.removed) writer_->remove_tile(id);
}

template <class Step>
void Checkpointer::unless_failed(Step&& step) {
  if (error_) return;
  try {
    step();
  } catch (...) {
    error_ = std::current_exception();
  }
}

void Checkpointer::perform(Task& task) {
  std::visit([this](auto& t) { perform(t); }, task);
}

void Checkpointer::perform(ChangedRows& changed) {
  unless_failed([&] { write(changed); });
}

void Checkpointer::perform(TileSnapshot& tile) {
  unless_failed([&] { writer_->put_tile(tile.id, *tile.points); });
}

void Checkpointer::perform(Commit& commit) {
  unless_failed([&] {
    if (!options_.commit_at_end) writer_->commit();
    if (resident_memory() > options_.memory - options_.memory / 4) release_free_memory();
    commit.done.set_value();
  });
  if (error_) commit.done.set_exception(error_);
}

void Checkpointer::perform(TileRead& read) {
  unless_failed([&] { read.points.set_value(writer_->read_tile(read.id)); });
  if (error_) read.points.set_exception(error_);
}

}  // namespace fovea
