#include "fovea/server/client_sync.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/errors.h"
#include "fovea/exporting/viewer/map_description.h"
#include "fovea/server/live_sample.h"

namespace fovea {
namespace {

using Json = nlohmann::json;

/// Limit of a message of tiles, bytes: newer messages must not wait long.
constexpr std::size_t kTilesMessage = 256 * 1024;
constexpr int kNoFrame = -1;

WebMessage text(const Json& json) {
  return {std::make_shared<const std::string>(json.dump()), false};
}

Json frame_json(const ShownFrame& frame, std::optional<TimeNs> first, int done, int total) {
  const FrameRecord& record = frame.record;
  return {{"type", "frame"},
          {"index", record.index},
          {"time", time_json(record, first)},
          {"status", to_string(record.status)},
          {"T_local_lidar", matrix_rows(record.T_local_lidar)},
          {"milliseconds", milliseconds_json(record)},
          {"score", score_json(record)},
          {"points", frame.points},
          {"done", done},
          {"total", total},
          {"late", frame.late},
          {"late_frames", frame.late_frames},
          {"mapped_at", frame.mapped_at}};
}

}  // namespace

ClientSync::ClientSync(LiveSession& session) : session_(session) {
  const std::lock_guard lock(session_.guard_);
  session_.clients_.insert(this);
}

ClientSync::~ClientSync() {
  const std::lock_guard lock(session_.guard_);
  session_.clients_.erase(this);
}

std::optional<WebMessage> ClientSync::next() {
  if (!greeted_) return greeting();
  if (auto message = small_message()) return message;
  // Images and tiles in turns: a slow client must not wait for tiles until the end.
  if (std::exchange(image_was_last_, false)) {
    if (auto message = tiles_message()) return message;
  }
  if (std::shared_ptr<ShownImage> image = new_image()) {
    image_was_last_ = true;
    return WebMessage{image->message(), true};
  }
  if (auto message = tiles_message()) return message;
  const std::lock_guard lock(session_.guard_);
  const bool all = next_frame_ == session_.frames_.size() && queued_tiles_.empty();
  if (!session_.ended_ || !all || has_ended_) return std::nullopt;
  has_ended_ = true;
  return text({{"type", "end"}});
}

void ClientSync::queue_missed_tiles(const std::vector<TileId>& written) {
  constexpr int kCheckpoints = 2;
  if (checkpoints_seen_ < kCheckpoints) queue_tiles(written);
  ++checkpoints_seen_;
}

WebMessage ClientSync::greeting() {
  std::vector<FrameRecord> records;
  {
    const std::lock_guard lock(session_.guard_);
    greeted_ = true;
    next_frame_ = session_.frames_.size();
    poses_known_ = session_.poses_moved_;
    increments_taken_ = session_.increments_made_;
    T_local_submap_ = session_.T_local_submap_;
    records = session_.records();
  }
  Json hello = {{"type", "hello"},
                {"session", session_.id_},
                {"frames", fovea::frames_json(records)},
                {"T_local_submap", Json::array()},
                {"done", records.size()},
                {"total", session_.total_}};
  for (const RigidMotion& T : T_local_submap_) {
    hello["T_local_submap"].push_back(matrix_rows(T));
  }
  return text(hello);
}

std::optional<WebMessage> ClientSync::small_message() {
  const std::lock_guard lock(session_.guard_);
  if (auto message = new_poses()) return message;
  if (next_frame_ < session_.frames_.size()) {
    const std::size_t place = next_frame_++;
    return text(frame_json(session_.frames_[place], session_.first_stamp_,
                           static_cast<int>(next_frame_), session_.total_));
  }
  // A slow client misses points of frames; it gets them with queued tiles.
  const std::size_t oldest = session_.increments_made_ - session_.increments_.size();
  if (increments_taken_ < oldest) {
    increments_taken_ = oldest;
    checkpoints_seen_ = 0;
  }
  if (increments_taken_ == session_.increments_made_) return std::nullopt;
  return WebMessage{session_.increments_[increments_taken_++ - oldest], true};
}

std::optional<WebMessage> ClientSync::new_poses() {
  Json submaps = Json::object(), frames = Json::object();
  for (std::size_t i = 0; i < session_.T_local_submap_.size(); ++i) {
    const RigidMotion& T = session_.T_local_submap_[i];
    if (i < T_local_submap_.size() && T_local_submap_[i].matrix() == T.matrix()) continue;
    submaps[fmt::to_string(i)] = matrix_rows(T);
  }
  const auto tell = [&](std::size_t place) {
    const FrameRecord& record = session_.frames_[place].record;
    frames[fmt::to_string(record.index)] = matrix_rows(record.T_local_lidar);
  };
  const std::size_t missed = session_.poses_moved_ - poses_known_;
  if (missed > session_.moved_frames_.size()) {
    for (std::size_t place = 0; place < next_frame_; ++place) tell(place);
  } else {
    for (std::size_t i = session_.moved_frames_.size() - missed; i < session_.moved_frames_.size();
         ++i) {
      for (const int place : session_.moved_frames_[i]) tell(static_cast<std::size_t>(place));
    }
  }
  if (submaps.empty() && missed == 0) return std::nullopt;
  T_local_submap_ = session_.T_local_submap_;
  poses_known_ = session_.poses_moved_;
  return text({{"type", "poses"}, {"T_local_submap", submaps}, {"T_local_lidar", frames}});
}

std::shared_ptr<ShownImage> ClientSync::new_image() {
  const std::lock_guard lock(session_.guard_);
  if (session_.image_ == image_) return nullptr;
  image_ = session_.image_;
  return image_;
}

std::optional<WebMessage> ClientSync::tiles_message() {
  if (!has_read_file_) queue_stored_tiles();
  std::string sections;
  std::size_t count = 0;
  while (sections.size() < kTilesMessage) {
    TileId id;
    LiveSession::Bytes section;
    {
      const std::lock_guard lock(session_.guard_);
      // New points go first. The tile has them already, and must not get them twice.
      if (queued_tiles_.empty() || increments_taken_ != session_.increments_made_) break;
      id = *queued_tiles_.rbegin();
      queued_tiles_.erase(id);
      section = session_.section_of(id);
    }
    if (section) {
      sections += *section;
      ++count;
    } else {
      count += append_stored(id, sections);
    }
  }
  if (count == 0) {
    const std::lock_guard lock(session_.guard_);
    if (!queued_tiles_.empty()) return std::nullopt;
    reader_.reset();  // the writer can merge its log only if no reader is open
    return std::nullopt;
  }
  return WebMessage{std::make_shared<const std::string>(points_header(kNoFrame, count) + sections),
                    true};
}

void ClientSync::queue_stored_tiles() {
  {
    const std::lock_guard lock(session_.guard_);
    if (!session_.has_file_) return;
  }
  has_read_file_ = true;
  std::vector<TileId> tiles;
  reader_.emplace(session_.map_);
  for (const auto& [id, points] : reader_->tile_sizes()) tiles.push_back(id);
  const std::lock_guard lock(session_.guard_);
  queue_tiles(tiles);
}

bool ClientSync::append_stored(const TileId& id, std::string& sections) {
  if (!reader_) reader_.emplace(session_.map_);
  try {
    const std::optional<TilePoints> tile = reader_->find_tile(id);
    LiveSample sample;
    if (tile) sample.more(*tile, session_.tile_size_);  // else it has gone meanwhile
    append_section(sections, id, tile ? &*tile : nullptr, sample.all(), /*whole=*/true);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace fovea
