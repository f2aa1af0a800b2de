// A camera image of a live session.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "fovea/image.h"

namespace fovea {

/// An image of a camera. The first client that needs it makes the JPEG.
class ShownImage {
 public:
  ShownImage(int frame, int camera, Image image)
      : frame_(frame), camera_(camera), image_(std::move(image)) {}
  /// Reduced to half its width, as a message. For several threads.
  std::shared_ptr<const std::string> message();

 private:
  int frame_, camera_;
  Image image_;
  std::once_flag made_;
  std::shared_ptr<const std::string> message_;
};

}  // namespace fovea
