#include "fovea/server/map_server.h"

#include <utility>

namespace fovea {

MapServer::MapServer(std::unique_ptr<SiteContent> content, std::span<const PageFile> page,
                     std::shared_ptr<const FrameImages> images, const WebServerOptions& options)
    : site_(std::make_unique<MapSite>(std::move(content), page, std::move(images))),
      server_(options, [this](const std::string& path, WebServer::Reply reply) {
        site_->answer(path, std::move(reply));
      }) {}

MapServer::~MapServer() {
  server_.stop();
  site_.reset();  // with it the replies that it keeps for later
}

}  // namespace fovea
