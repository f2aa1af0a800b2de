// Serves a map to browsers while it grows, and after.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>

#include "fovea/exporting/viewer/map_description.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/server/live_sample.h"
#include "fovea/server/live_session.h"
#include "fovea/server/map_site.h"
#include "fovea/server/web_server.h"

namespace fovea {

/// Serves from construction to destruction, as the observer of map_drive(). Its calls in the
/// mapping thread are short, and almost free without clients. Background threads do the rest.
class LiveMapServer : public MapObserver {
 public:
  /// @param job     of the run; must outlive this, as must `page`
  /// @param images  of the drive
  /// @throws OutputError  as WebServer
  /// @throws InputError   if the map to resume cannot be read
  LiveMapServer(const MapJob& job, std::shared_ptr<FrameImages> images,
                std::span<const PageFile> page, const WebServerOptions& options);
  ~LiveMapServer() override;

  std::string url() const { return server_.url(); }

  void frame_mapped(const FrameRecord& record, const Frame* frame, const TileMap& map) override;
  void map_changed(const TileChanges& changes, const MapRows& rows, const TileMap& map) override;
  /// Serves the file from now on, since it has the whole map.
  /// @throws InputError  if it cannot be read
  void finish();

 private:
  void answer(const std::string& path, WebServer::Reply reply);
  std::string live_json() const;
  LiveSession::Bytes new_points(int frame, const TileMap& map);
  LiveSession::Bytes whole_section(const TileId& id, const TileMap& map);
  std::shared_ptr<ShownImage> next_image(const Frame* frame);

  const MapJob& job_;
  std::shared_ptr<FrameImages> images_;
  std::span<const PageFile> page_;
  MapDescription description_;
  LiveSession session_;

  // Of the mapping thread.
  int late_frames_ = 0;
  std::set<TileId> changing_;             // by the last checkpoint
  std::map<TileId, LiveSample> samples_;  // of tiles that change
  std::int64_t image_at_ = 0;             // ms, of the last image sent

  mutable std::mutex guard_;
  std::shared_ptr<MapSite> site_;  // guarded; null until finish()
  WebServer server_;
};

}  // namespace fovea
