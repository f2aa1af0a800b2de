#include "fovea/server/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

#include "fovea/exporting/viewer/map_description.h"
#include "fovea/server/client_sync.h"

namespace fovea {

LiveSession::LiveSession(std::filesystem::path map, bool has_file, double tile_size, int total)
    : map_(std::move(map)), tile_size_(tile_size), total_(total), has_file_(has_file) {
  std::random_device random;
  id_ = fmt::format("{:08x}{:08x}", random(), random());
}

bool LiveSession::has_clients() const {
  const std::lock_guard lock(guard_);
  return !clients_.empty();
}

void LiveSession::resume_from(const std::vector<FrameRecord>& frames, std::size_t points) {
  const std::lock_guard lock(guard_);
  for (const FrameRecord& record : frames) {
    if (!first_stamp_) first_stamp_ = record.stamp;
    ShownFrame frame;
    frame.record = record;
    frame.points = points;
    frames_.push_back(std::move(frame));
  }
}

void LiveSession::add_frame(ShownFrame frame, const std::vector<RigidMotion>& T_local_submap,
                            Bytes points, std::shared_ptr<ShownImage> image) {
  const std::lock_guard lock(guard_);
  if (!first_stamp_) first_stamp_ = frame.record.stamp;
  frames_.push_back(std::move(frame));
  if (frames_.size() > kTimedFrames) {
    frames_[frames_.size() - kTimedFrames - 1].record.milliseconds.clear();
  }
  T_local_submap_ = T_local_submap;
  if (image) image_ = std::move(image);
  if (!points) return;
  increments_.push_back(std::move(points));
  ++increments_made_;
  if (increments_.size() > kLatest) increments_.pop_front();
}

void LiveSession::move_frames(const std::vector<std::pair<int, RigidMotion>>& T_local_lidar) {
  if (T_local_lidar.empty()) return;
  const std::lock_guard lock(guard_);
  std::vector<int> places;
  for (const auto& [index, T] : T_local_lidar) {
    const auto frame =
        std::lower_bound(frames_.begin(), frames_.end(), index,
                         [](const ShownFrame& a, int number) { return a.record.index < number; });
    if (frame == frames_.end() || frame->record.index != index) continue;
    frame->record.T_local_lidar = T;
    places.push_back(static_cast<int>(frame - frames_.begin()));
  }
  ++poses_moved_;
  moved_frames_.push_back(std::move(places));
  if (moved_frames_.size() > kPoseChanges) moved_frames_.pop_front();
}

void LiveSession::checkpoint(std::vector<TileId> written, const std::vector<TileId>& settled,
                             std::map<TileId, Bytes> tiles) {
  const std::lock_guard lock(guard_);
  for (ClientSync* client : clients_) {
    client->queue_tiles(settled);
    client->queue_missed_tiles(written_);
  }
  has_file_ = has_file_ || checkpoints_++ > 0;
  written_ = std::move(written);
  tiles_before_ = std::move(tiles_);
  tiles_ = std::move(tiles);
}

void LiveSession::end() {
  const std::lock_guard lock(guard_);
  for (ClientSync* client : clients_) client->queue_tiles(written_);
  tiles_.clear();
  tiles_before_.clear();
  has_file_ = true;
  ended_ = true;
}

LiveSession::Bytes LiveSession::section_of(const TileId& id) const {
  for (const auto* tiles : {&tiles_, &tiles_before_}) {
    const auto found = tiles->find(id);
    if (found != tiles->end()) return found->second;
  }
  return nullptr;
}

std::vector<FrameRecord> LiveSession::records() const {
  std::vector<FrameRecord> records;
  records.reserve(frames_.size());
  for (const ShownFrame& frame : frames_) records.push_back(frame.record);
  return records;
}

std::string LiveSession::frames_json() const {
  std::vector<FrameRecord> all;
  {
    const std::lock_guard lock(guard_);
    all = records();
  }
  return fovea::frames_json(all).dump();
}

std::size_t LiveSession::points() const {
  const std::lock_guard lock(guard_);
  return frames_.empty() ? 0 : frames_.back().points;
}

std::unique_ptr<WebFeed> LiveSession::make_feed() { return std::make_unique<ClientSync>(*this); }

}  // namespace fovea
