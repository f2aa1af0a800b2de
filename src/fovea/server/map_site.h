// A finished map or city as a web site: the viewer's page, tiles and frames, the drive's images.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "fovea/drive/frame_source.h"
#include "fovea/exporting/viewer/viewer_folder.h"
#include "fovea/map/color_display.h"
#include "fovea/server/site_content.h"
#include "fovea/server/web_server.h"

namespace fovea {

/// The media type of a file ending.
std::string media_type(std::string_view name);

/// The response with a file of the page; "" is index.html. Status 404 if the page has no such file.
WebResponse page_response(std::span<const PageFile> page, const std::string& path);

/// The images of a drive as JPEG.
class DriveImages {
 public:
  /// @param drive  with the cameras that the map shows and the map's numbers of its frames
  explicit DriveImages(std::shared_ptr<const FrameSource> drive) : drive_(std::move(drive)) {}
  const DriveInfo& info() const { return drive_->info(); }
  /// Whether a path of the site names an image.
  static bool has(std::string_view path) { return path.starts_with(kFolder); }
  /// The response for "images/FRAME/CAMERA.jpg". Status 404 if there is no such image.
  WebResponse response(std::string_view path) const;

 private:
  static constexpr std::string_view kFolder = "images/";
  std::shared_ptr<const FrameSource> drive_;
};

/// The HTTP part of docs/viewer-protocol.md. Thread-safe.
class MapSite {
 public:
  /// @param page    must outlive the site
  /// @param images  may be null
  MapSite(std::unique_ptr<SiteContent> content, std::span<const PageFile> page,
          std::shared_ptr<const DriveImages> images)
      : page_(page), images_(std::move(images)), content_(std::move(content)) {}

  void answer(const std::string& path, WebServer::Reply reply);

 private:
  std::span<const PageFile> page_;
  std::shared_ptr<const DriveImages> images_;
  std::unique_ptr<SiteContent> content_;
};

/// A map: its description, frames and tiles.
/// @param images    may be null
/// @param exposure  of the colors
/// @throws InputError  if the map cannot be read
std::unique_ptr<SiteContent> make_map_content(const std::filesystem::path& map,
                                              const DriveImages* images,
                                              const ExposureChoice& exposure = {});

}  // namespace fovea
