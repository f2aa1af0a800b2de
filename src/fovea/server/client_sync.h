// Sends a live session to one client.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/server/live_session.h"

namespace fovea {

/// Tracks what one client has. The guard of the session protects all members but those that only
/// next() uses.
class ClientSync : public WebFeed {
 public:
  explicit ClientSync(LiveSession& session);
  ~ClientSync() override;

  std::optional<WebMessage> next() override;

  // The session calls these under its guard.

  void queue_tiles(const std::vector<TileId>& tiles) {
    queued_tiles_.insert(tiles.begin(), tiles.end());
  }
  /// Queues the tiles of the last checkpoint for a client that missed points of frames: they were
  /// not in the file when the client read it.
  void queue_missed_tiles(const std::vector<TileId>& written);

 private:
  WebMessage greeting();

  /// Poses, then the next frame, then its points.
  std::optional<WebMessage> small_message();

  std::optional<WebMessage> new_poses();

  std::shared_ptr<ShownImage> new_image();

  /// The last queued tiles, as many as fit into a message.
  std::optional<WebMessage> tiles_message();

  /// Queues all tiles of the file, if it exists. Checkpoints queue later tiles.
  void queue_stored_tiles();

  /// False if the tile cannot be read: the client keeps what it has.
  bool append_stored(const TileId& id, std::string& sections);

  LiveSession& session_;
  bool greeted_ = false, has_ended_ = false, has_read_file_ = false, image_was_last_ = false;
  int checkpoints_seen_ = 0;  // since it has missed points
  std::size_t next_frame_ = 0, poses_known_ = 0, increments_taken_ = 0;
  std::vector<RigidMotion> T_local_submap_;
  std::shared_ptr<ShownImage> image_;
  std::set<TileId> queued_tiles_;
  std::optional<MapReader> reader_;
};

}  // namespace fovea
