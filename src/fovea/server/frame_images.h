// The images of frames that a site shows.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "fovea/drive/frame_source.h"
#include "fovea/server/web_server.h"

namespace fovea {

/// The images of frames as JPEG. Thread-safe.
class FrameImages {
 public:
  virtual ~FrameImages() = default;
  /// The drive, with the cameras that the map shows and the map's numbers of its frames.
  virtual const DriveInfo& info() const = 0;
  /// Takes the next frame that is mapped, if its images cannot be read again.
  virtual void add(const Frame& /*frame*/) {}
  /// Whether a path of the site names an image.
  static bool has(std::string_view path) { return path.starts_with(kFolder); }
  /// The response for "images/FRAME/CAMERA.jpg". Status 404 if there is no such image.
  WebResponse response(std::string_view path) const;

 protected:
  static WebResponse no_image();

 private:
  static constexpr std::string_view kFolder = "images/";

  /// @param camera  its number
  virtual WebResponse image(int frame, int camera) const = 0;
};

/// The images of a drive that can be read.
class DriveImages : public FrameImages {
 public:
  explicit DriveImages(std::shared_ptr<const FrameSource> drive) : drive_(std::move(drive)) {}
  const DriveInfo& info() const override { return drive_->info(); }

 private:
  WebResponse image(int frame, int camera) const override;

  std::shared_ptr<const FrameSource> drive_;
};

/// An image as a file of the site.
std::shared_ptr<const std::string> photograph_jpeg(const Image& image);
WebResponse photograph_response(std::shared_ptr<const std::string> jpeg);

}  // namespace fovea
