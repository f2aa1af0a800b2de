// The state of a growing map that its clients see.
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
#include "fovea/server/shown_image.h"
#include "fovea/server/web_server.h"

namespace fovea {

class ClientSync;

/// A frame as the clients get it.
struct ShownFrame {
  FrameRecord record;      ///< with the score as its only figure
  std::size_t points = 0;  ///< of the map, after this frame
  bool late = false;
  int late_frames = 0;         ///< up to this frame
  std::int64_t mapped_at = 0;  ///< ms since 1970
};

/// The mapping thread adds frames and tiles; a ClientSync sends them to each client in the threads
/// of the server. A client gets the new points of each frame, and each whole tile after its last
/// change. The memory does not grow with the map: the session holds the poses of the frames, the
/// points of the last frames, and the tiles of the last two checkpoints. New and slow clients get
/// the rest from the map's file.
class LiveSession {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  /// @param map       its file
  /// @param has_file  whether the file is of this map: before the first commit, another map may
  ///                  have its name
  /// @param total     frames of the drive; 0: not known
  LiveSession(std::filesystem::path map, bool has_file, double tile_size, int total);

  // For the mapping thread.

  /// Adds the frames of an earlier run.
  /// @param points  of the map
  void resume_from(const std::vector<FrameRecord>& frames, std::size_t points);
  bool has_clients() const;
  /// @param points  a message; nullptr without clients
  /// @param image   or nullptr
  void add_frame(ShownFrame frame, const std::vector<RigidMotion>& T_local_submap, Bytes points,
                 std::shared_ptr<ShownImage> image);
  /// Poses of earlier frames that a closed loop has moved.
  void move_frames(const std::vector<std::pair<int, RigidMotion>>& T_local_lidar);
  /// Call it when the file has all tiles of the checkpoint before.
  /// @param written  tiles that this checkpoint will write or remove
  /// @param settled  tiles to send again: those of the checkpoint before that this one does not
  ///                 write, and those that it removes
  /// @param tiles    message sections of the settled tiles; none without clients
  void checkpoint(std::vector<TileId> written, const std::vector<TileId>& settled,
                  std::map<TileId, Bytes> tiles);
  /// The file has the whole map.
  void end();

  // For any thread.

  std::string frames_json() const;
  std::size_t points() const;
  std::unique_ptr<WebFeed> make_feed();

 private:
  static constexpr std::size_t kLatest = 5;          // frames whose points are kept
  static constexpr std::size_t kTimedFrames = 1000;  // whose stages' times are kept
  static constexpr std::size_t kPoseChanges = 8;     // that are kept one by one

  friend class ClientSync;

  // Under the guard.
  std::vector<FrameRecord> records() const;
  Bytes section_of(const TileId& id) const;

  std::filesystem::path map_;
  double tile_size_;
  int total_;
  std::string id_;

  mutable std::mutex guard_;  // of what follows
  std::vector<ShownFrame> frames_;
  std::optional<TimeNs> first_stamp_;
  std::vector<RigidMotion> T_local_submap_;
  std::size_t poses_moved_ = 0;                // how often
  std::deque<std::vector<int>> moved_frames_;  // by place in frames_, of the last times
  std::size_t increments_made_ = 0;
  std::deque<Bytes> increments_;  // the last of them
  std::shared_ptr<ShownImage> image_;
  std::map<TileId, Bytes> tiles_, tiles_before_;  // settled at the last checkpoints
  std::vector<TileId> written_;                   // by the last checkpoint
  std::set<ClientSync*> clients_;
  std::size_t checkpoints_ = 0;
  bool has_file_;
  bool ended_ = false;
};

}  // namespace fovea
