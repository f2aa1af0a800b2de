#include "fovea/server/live_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

#include "fovea/core/errors.h"
#include "fovea/exporting/jpeg_encode.h"
#include "fovea/exporting/viewer/map_description.h"
#include "fovea/map/map_store.h"
#include "fovea/map/point_files/byte_packer.h"
#include "fovea/server/live_sample.h"

namespace fovea {
namespace {

using Json = nlohmann::json;

constexpr int kLiveJpegQuality = 75;
constexpr std::uint32_t kImageKind = 2;
constexpr std::size_t kTilesMessage = 256 * 1024;  // bytes, about: newer things must not wait long
constexpr int kNoFrame = -1;

WebMessage text(const Json& json) {
  return {std::make_shared<const std::string>(json.dump()), false};
}

Json frame_json(const LiveFrame& frame, std::optional<TimeNs> first, int done, int total) {
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

/// Half as wide and high: the mean of four pixels.
Image halved(const Image& image) {
  Image half(std::max(image.width / 2, 1), std::max(image.height / 2, 1), image.channels);
  for (int v = 0; v < half.height; ++v) {
    const int v1 = std::min(2 * v + 1, image.height - 1);
    for (int u = 0; u < half.width; ++u) {
      const int u1 = std::min(2 * u + 1, image.width - 1);
      for (int c = 0; c < image.channels; ++c) {
        const int sum = image.pixel(2 * u, 2 * v)[c] + image.pixel(u1, 2 * v)[c] +
                        image.pixel(2 * u, v1)[c] + image.pixel(u1, v1)[c];
        half.pixel(u, v)[c] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return half;
}

}  // namespace

std::shared_ptr<const std::string> LiveImage::message() {
  std::call_once(made_, [this] {
    std::string bytes;
    BytePacker packer(bytes);
    packer.put(kImageKind);
    packer.put(static_cast<std::int32_t>(frame_));
    packer.put(static_cast<std::uint32_t>(camera_));
    const std::vector<std::uint8_t> jpeg = encode_jpeg(halved(image_), kLiveJpegQuality);
    bytes.append(jpeg.begin(), jpeg.end());
    message_ = std::make_shared<const std::string>(std::move(bytes));
    image_ = {};
  });
  return message_;
}

/// What one client has been shown. All but what only its own next() uses is under the board's
/// guard.
class LiveBoard::Feed : public WebFeed {
 public:
  explicit Feed(LiveBoard& board) : board_(board) {
    const std::lock_guard lock(board_.guard_);
    board_.feeds_.insert(this);
  }
  ~Feed() override {
    const std::lock_guard lock(board_.guard_);
    board_.feeds_.erase(this);
  }

  std::optional<WebMessage> next() override {
    if (!greeted_) return greeting();
    if (auto message = small_message()) return message;
    // In turns: a client that takes a while for each must not wait for tiles until the end.
    if (std::exchange(image_was_last_, false)) {
      if (auto message = owed_tiles()) return message;
    }
    if (std::shared_ptr<LiveImage> image = new_image()) {
      image_was_last_ = true;
      return WebMessage{image->message(), true};
    }
    if (auto message = owed_tiles()) return message;
    const std::lock_guard lock(board_.guard_);
    const bool all = next_frame_ == board_.frames_.size() && owed_.empty();
    if (!board_.ended_ || !all || said_end_) return std::nullopt;
    said_end_ = true;
    return text({{"type", "end"}});
  }

  /// Under the guard.
  void owe(const std::vector<TileId>& tiles) { owed_.insert(tiles.begin(), tiles.end()); }
  /// A client that has not seen the points of all frames is owed what the last checkpoints before
  /// it did were about to write: they were not in the file when that was read for it.
  void owe_missed(const std::vector<TileId>& written) {
    constexpr int kCheckpoints = 2;
    if (checkpoints_seen_ < kCheckpoints) owe(written);
    ++checkpoints_seen_;
  }

 private:
  WebMessage greeting() {
    std::vector<FrameRecord> records;
    {
      const std::lock_guard lock(board_.guard_);
      greeted_ = true;
      next_frame_ = board_.frames_.size();
      poses_known_ = board_.poses_moved_;
      increments_taken_ = board_.increments_made_;
      T_local_submap_ = board_.T_local_submap_;
      records = board_.records();
    }
    Json hello = {{"type", "hello"},
                  {"session", board_.session_},
                  {"frames", fovea::frames_json(records)},
                  {"T_local_submap", Json::array()},
                  {"done", records.size()},
                  {"total", board_.total_}};
    for (const RigidMotion& T : T_local_submap_) {
      hello["T_local_submap"].push_back(matrix_rows(T));
    }
    return text(hello);
  }

  /// Poses, then the next frame, then its points.
  std::optional<WebMessage> small_message() {
    const std::lock_guard lock(board_.guard_);
    if (auto message = new_poses()) return message;
    if (next_frame_ < board_.frames_.size()) {
      const std::size_t place = next_frame_++;
      return text(frame_json(board_.frames_[place], board_.first_stamp_,
                             static_cast<int>(next_frame_), board_.total_));
    }
    // Of a client that has fallen behind, the points of frames left out are in tiles that it is
    // owed.
    const std::size_t oldest = board_.increments_made_ - board_.increments_.size();
    if (increments_taken_ < oldest) {
      increments_taken_ = oldest;
      checkpoints_seen_ = 0;
    }
    if (increments_taken_ == board_.increments_made_) return std::nullopt;
    return WebMessage{board_.increments_[increments_taken_++ - oldest], true};
  }

  std::optional<WebMessage> new_poses() {
    Json submaps = Json::object(), frames = Json::object();
    for (std::size_t i = 0; i < board_.T_local_submap_.size(); ++i) {
      const RigidMotion& T = board_.T_local_submap_[i];
      if (i < T_local_submap_.size() && T_local_submap_[i].matrix() == T.matrix()) continue;
      submaps[fmt::to_string(i)] = matrix_rows(T);
    }
    const auto tell = [&](std::size_t place) {
      const FrameRecord& record = board_.frames_[place].record;
      frames[fmt::to_string(record.index)] = matrix_rows(record.T_local_lidar);
    };
    const std::size_t missed = board_.poses_moved_ - poses_known_;
    if (missed > board_.moved_frames_.size()) {
      for (std::size_t place = 0; place < next_frame_; ++place) tell(place);
    } else {
      for (std::size_t i = board_.moved_frames_.size() - missed; i < board_.moved_frames_.size();
           ++i) {
        for (const int place : board_.moved_frames_[i]) tell(static_cast<std::size_t>(place));
      }
    }
    if (submaps.empty() && missed == 0) return std::nullopt;
    T_local_submap_ = board_.T_local_submap_;
    poses_known_ = board_.poses_moved_;
    return text({{"type", "poses"}, {"T_local_submap", submaps}, {"T_local_lidar", frames}});
  }

  std::shared_ptr<LiveImage> new_image() {
    const std::lock_guard lock(board_.guard_);
    if (board_.image_ == image_) return nullptr;
    image_ = board_.image_;
    return image_;
  }

  /// The latest tiles that it is owed, as many as fit a message.
  std::optional<WebMessage> owed_tiles() {
    if (!has_read_file_) owe_file();
    std::string sections;
    std::size_t count = 0;
    while (sections.size() < kTilesMessage) {
      TileId id;
      Bytes section;
      {
        const std::lock_guard lock(board_.guard_);
        // Points that came meanwhile go first: a tile has them already, and is not to have them
        // twice.
        if (owed_.empty() || increments_taken_ != board_.increments_made_) break;
        id = *owed_.rbegin();
        owed_.erase(id);
        section = board_.section_of(id);
      }
      if (section) {
        sections += *section;
        ++count;
      } else {
        count += append_stored(id, sections);
      }
    }
    if (count == 0) {
      const std::lock_guard lock(board_.guard_);
      if (!owed_.empty()) return std::nullopt;
      reader_.reset();  // a writer that ends makes the map one file only where nobody reads it
      return std::nullopt;
    }
    return WebMessage{
        std::make_shared<const std::string>(points_header(kNoFrame, count) + sections), true};
  }

  /// All that the file has, once there is one; what comes later is owed by checkpoints.
  void owe_file() {
    {
      const std::lock_guard lock(board_.guard_);
      if (!board_.has_file_) return;
    }
    has_read_file_ = true;
    std::vector<TileId> tiles;
    reader_.emplace(board_.map_);
    for (const auto& [id, points] : reader_->tile_sizes()) tiles.push_back(id);
    const std::lock_guard lock(board_.guard_);
    owe(tiles);
  }

  /// False if the tile cannot be read: what the client has of it stays.
  bool append_stored(const TileId& id, std::string& sections) {
    if (!reader_) reader_.emplace(board_.map_);
    try {
      const std::optional<TilePoints> tile = reader_->find_tile(id);
      LiveSample sample;
      if (tile) sample.more(*tile, board_.tile_size_);  // else it has gone meanwhile
      append_section(sections, id, tile ? &*tile : nullptr, sample.all(), /*whole=*/true);
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  LiveBoard& board_;
  bool greeted_ = false, said_end_ = false, has_read_file_ = false, image_was_last_ = false;
  int checkpoints_seen_ = 0;  // since it has missed points
  std::size_t next_frame_ = 0, poses_known_ = 0, increments_taken_ = 0;
  std::vector<RigidMotion> T_local_submap_;
  std::shared_ptr<LiveImage> image_;
  std::set<TileId> owed_;
  std::optional<MapReader> reader_;
};

LiveBoard::LiveBoard(std::filesystem::path map, bool has_file, double tile_size, int total)
    : map_(std::move(map)), tile_size_(tile_size), total_(total), has_file_(has_file) {
  std::random_device random;
  session_ = fmt::format("{:08x}{:08x}", random(), random());
}

bool LiveBoard::has_feeds() const {
  const std::lock_guard lock(guard_);
  return !feeds_.empty();
}

void LiveBoard::take_up(const std::vector<FrameRecord>& frames, std::size_t points) {
  const std::lock_guard lock(guard_);
  for (const FrameRecord& record : frames) {
    if (!first_stamp_) first_stamp_ = record.stamp;
    LiveFrame frame;
    frame.record = record;
    frame.points = points;
    frames_.push_back(std::move(frame));
  }
}

void LiveBoard::add_frame(LiveFrame frame, const std::vector<RigidMotion>& T_local_submap,
                          Bytes points, std::shared_ptr<LiveImage> image) {
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

void LiveBoard::move_frames(const std::vector<std::pair<int, RigidMotion>>& T_local_lidar) {
  if (T_local_lidar.empty()) return;
  const std::lock_guard lock(guard_);
  std::vector<int> places;
  for (const auto& [index, T] : T_local_lidar) {
    const auto frame =
        std::lower_bound(frames_.begin(), frames_.end(), index,
                         [](const LiveFrame& a, int number) { return a.record.index < number; });
    if (frame == frames_.end() || frame->record.index != index) continue;
    frame->record.T_local_lidar = T;
    places.push_back(static_cast<int>(frame - frames_.begin()));
  }
  ++poses_moved_;
  moved_frames_.push_back(std::move(places));
  if (moved_frames_.size() > kPoseChanges) moved_frames_.pop_front();
}

void LiveBoard::checkpoint(std::vector<TileId> written, const std::vector<TileId>& settled,
                           std::map<TileId, Bytes> tiles) {
  const std::lock_guard lock(guard_);
  for (Feed* feed : feeds_) {
    feed->owe(settled);
    feed->owe_missed(written_);
  }
  has_file_ = has_file_ || checkpoints_++ > 0;
  written_ = std::move(written);
  tiles_before_ = std::move(tiles_);
  tiles_ = std::move(tiles);
}

void LiveBoard::end() {
  const std::lock_guard lock(guard_);
  for (Feed* feed : feeds_) feed->owe(written_);
  tiles_.clear();
  tiles_before_.clear();
  has_file_ = true;
  ended_ = true;
}

LiveBoard::Bytes LiveBoard::section_of(const TileId& id) const {
  for (const auto* tiles : {&tiles_, &tiles_before_}) {
    const auto found = tiles->find(id);
    if (found != tiles->end()) return found->second;
  }
  return nullptr;
}

std::vector<FrameRecord> LiveBoard::records() const {
  std::vector<FrameRecord> records;
  records.reserve(frames_.size());
  for (const LiveFrame& frame : frames_) records.push_back(frame.record);
  return records;
}

std::string LiveBoard::frames_json() const {
  std::vector<FrameRecord> all;
  {
    const std::lock_guard lock(guard_);
    all = records();
  }
  return fovea::frames_json(all).dump();
}

std::size_t LiveBoard::points() const {
  const std::lock_guard lock(guard_);
  return frames_.empty() ? 0 : frames_.back().points;
}

std::unique_ptr<WebFeed> LiveBoard::make_feed() { return std::make_unique<Feed>(*this); }

}  // namespace fovea
