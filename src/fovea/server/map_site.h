// A finished map or city as a web site: the viewer's page, tiles and frames, the drive's images.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "fovea/exporting/viewer/viewer_folder.h"
#include "fovea/map/color_display.h"
#include "fovea/server/frame_images.h"
#include "fovea/server/site_content.h"
#include "fovea/server/web_server.h"

namespace fovea {

/// The media type of a file ending.
std::string media_type(std::string_view name);

/// The response with a file of the page; "" is index.html. Status 404 if the page has no such file.
WebResponse page_response(std::span<const PageFile> page, const std::string& path);

/// The HTTP part of docs/viewer-protocol.md. Thread-safe.
class MapSite {
 public:
  /// @param page    must outlive the site
  /// @param images  may be null
  MapSite(std::unique_ptr<SiteContent> content, std::span<const PageFile> page,
          std::shared_ptr<const FrameImages> images)
      : page_(page), images_(std::move(images)), content_(std::move(content)) {}

  void answer(const std::string& path, WebServer::Reply reply);

 private:
  std::span<const PageFile> page_;
  std::shared_ptr<const FrameImages> images_;
  std::unique_ptr<SiteContent> content_;
};

/// A map: its description, frames and tiles.
/// @param images    may be null
/// @param exposure  of the colors
/// @throws InputError  if the map cannot be read
std::unique_ptr<SiteContent> make_map_content(const std::filesystem::path& map,
                                              const FrameImages* images,
                                              const ExposureChoice& exposure = {});

}  // namespace fovea
