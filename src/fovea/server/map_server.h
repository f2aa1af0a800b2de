// Serves a finished map to browsers.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "fovea/server/map_site.h"
#include "fovea/server/web_server.h"

namespace fovea {

/// Serves a map file from construction to destruction. Errors as MapSite and WebServer.
class MapServer {
 public:
  MapServer(const std::filesystem::path& map, std::span<const PageFile> page,
            std::shared_ptr<const DriveImages> images, const WebServerOptions& options,
            const ExposureChoice& exposure = {});
  ~MapServer();

  std::string url() const { return server_.url(); }

 private:
  std::unique_ptr<MapSite> site_;
  WebServer server_;
};

}  // namespace fovea
