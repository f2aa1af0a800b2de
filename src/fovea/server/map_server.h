// Serves a finished map or city to browsers.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "fovea/server/map_site.h"
#include "fovea/server/web_server.h"

namespace fovea {

/// Serves from construction to destruction. Errors as WebServer.
class MapServer {
 public:
  /// Parameters as of MapSite.
  MapServer(std::unique_ptr<SiteContent> content, std::span<const PageFile> page,
            std::shared_ptr<const FrameImages> images, const WebServerOptions& options);
  ~MapServer();

  std::string url() const { return server_.url(); }

 private:
  std::unique_ptr<MapSite> site_;
  WebServer server_;
};

}  // namespace fovea
