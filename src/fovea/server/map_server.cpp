#include "fovea/server/map_server.h"

#include <utility>

namespace fovea {

MapServer::MapServer(const std::filesystem::path& map, std::span<const PageFile> page,
                     std::shared_ptr<const DriveImages> images, const WebServerOptions& options,
                     const ExposureChoice& exposure)
    : site_(std::make_unique<MapSite>(map, page, std::move(images), exposure)),
      server_(options, [this](const std::string& path, WebServer::Reply reply) {
        site_->answer(path, std::move(reply));
      }) {}

MapServer::~MapServer() {
  server_.stop();
  site_.reset();  // with it the replies that it keeps for later
}

}  // namespace fovea
