// What a growing map shows to all who look on, and what each of them has been shown.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/map/tile_map.h"
#include "fovea/server/web_server.h"

namespace fovea {

/// A frame as it is told of.
struct LiveFrame {
  FrameRecord record;      ///< of its figures only the score
  std::size_t points = 0;  ///< of the map, after it
  bool late = false;
  int late_frames = 0;         ///< up to it
  std::int64_t mapped_at = 0;  ///< ms since 1970
};

/// A camera's image, made a JPEG by the first who wants it.
class LiveImage {
 public:
  LiveImage(int frame, int camera, Image image)
      : frame_(frame), camera_(camera), image_(std::move(image)) {}
  /// Reduced to half its width, as a message. For several threads.
  std::shared_ptr<const std::string> message();

 private:
  int frame_, camera_;
  Image image_;
  std::once_flag made_;
  std::shared_ptr<const std::string> message_;
};

/// The mapping thread writes on it, feeds read it in the server's threads. A client is sent the new
/// points of each frame, and each tile as a whole when it changes no more. What the board holds
/// does not grow with the map: frames' poses, the points of the last few frames, and tiles of the
/// last two checkpoints. Everything else is in the map's file, which new and slow clients are
/// shown.
class LiveBoard {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  /// @param map       its file
  /// @param has_file  whether it is there: before a new map's first commit there may be another
  ///                  map under its name, which is not to be looked at
  /// @param total     frames of the drive
  LiveBoard(std::filesystem::path map, bool has_file, double tile_size, int total);

  // For the mapping thread.

  /// The frames of an earlier run that is gone on with.
  /// @param points  of the map
  void take_up(const std::vector<FrameRecord>& frames, std::size_t points);
  /// Whether anybody looks on.
  bool has_feeds() const;
  /// @param points  a message; nullptr where nobody looked on
  /// @param image   or nullptr
  void add_frame(LiveFrame frame, const std::vector<RigidMotion>& T_local_submap, Bytes points,
                 std::shared_ptr<LiveImage> image);
  /// Poses of earlier frames that a closed loop has moved.
  void move_frames(const std::vector<std::pair<int, RigidMotion>>& T_local_lidar);
  /// When all that the checkpoint before has written is in the file.
  /// @param written  tiles that this one is going to write or remove
  /// @param settled  tiles that the one before has written and this one does not, or removes: to be
  ///                 shown anew
  /// @param tiles    sections of a message of those settled; none where nobody looks on
  void checkpoint(std::vector<TileId> written, const std::vector<TileId>& settled,
                  std::map<TileId, Bytes> tiles);
  /// All is in the file.
  void end();

  // For any thread.

  std::string frames_json() const;
  std::size_t points() const;
  std::unique_ptr<WebFeed> make_feed();

 private:
  class Feed;
  static constexpr std::size_t kLatest = 5;          // frames whose points are kept
  static constexpr std::size_t kTimedFrames = 1000;  // whose stages' times are kept
  static constexpr std::size_t kPoseChanges = 8;     // that are kept one by one

  // Under the guard.
  std::vector<FrameRecord> records() const;
  Bytes section_of(const TileId& id) const;

  std::filesystem::path map_;
  double tile_size_;
  int total_;
  std::string session_;

  mutable std::mutex guard_;  // of what follows
  std::vector<LiveFrame> frames_;
  std::optional<TimeNs> first_stamp_;
  std::vector<RigidMotion> T_local_submap_;
  std::size_t poses_moved_ = 0;                // how often
  std::deque<std::vector<int>> moved_frames_;  // by place in frames_, of the last times
  std::size_t increments_made_ = 0;
  std::deque<Bytes> increments_;  // the last of them
  std::shared_ptr<LiveImage> image_;
  std::map<TileId, Bytes> tiles_, tiles_before_;  // settled at the last checkpoints
  std::vector<TileId> written_;                   // by the last checkpoint
  std::set<Feed*> feeds_;
  std::size_t checkpoints_ = 0;
  bool has_file_;
  bool ended_ = false;
};

}  // namespace fovea
