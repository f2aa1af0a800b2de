// A map shown in browsers while it is made, and after.
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

/// Serves from construction to destruction; to be given to map_drive() as observer. What it does in
/// the mapping thread is little, and nearly nothing where nobody looks on; the rest is done by
/// threads of low priority.
class LiveMapServer : public MapObserver {
 public:
  /// @param job     of the run; outlives the show, as `page` does
  /// @param images  of the drive
  /// OutputError as WebServer; InputError if the map to resume cannot be read.
  LiveMapServer(const MapJob& job, std::shared_ptr<const DriveImages> images,
                std::span<const PageFile> page, const WebServerOptions& options);
  ~LiveMapServer() override;

  std::string url() const { return server_.url(); }

  void frame_mapped(const FrameRecord& record, const Frame* frame, const TileMap& map) override;
  void map_changed(const TileChanges& changes, const MapRows& rows, const TileMap& map) override;
  /// The map is whole: from now on the file is shown. InputError if it cannot be read.
  void finish();

 private:
  void answer(const std::string& path, WebServer::Reply reply);
  std::string live_json() const;
  LiveSession::Bytes new_points(int frame, const TileMap& map);
  LiveSession::Bytes whole_section(const TileId& id, const TileMap& map);
  std::shared_ptr<LiveImage> next_image(const Frame* frame);

  const MapJob& job_;
  std::shared_ptr<const DriveImages> images_;
  std::span<const PageFile> page_;
  MapDescription description_;
  LiveSession session_;

  // The mapping thread's.
  int late_frames_ = 0;
  std::set<TileId> changing_;             // by the last checkpoint
  std::map<TileId, LiveSample> samples_;  // of tiles that change
  std::int64_t image_at_ = 0;             // ms, of the last one shown

  mutable std::mutex guard_;
  std::shared_ptr<MapSite> site_;  // guarded; once the map is whole
  WebServer server_;
};

}  // namespace fovea
