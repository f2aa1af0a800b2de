// Images as if a pinhole camera had taken them.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/camera.h"
#include "fovea/geometry/lens.h"
#include "fovea/image.h"

namespace fovea {

/// Resamples images of a camera with a lens by a table of where each pixel comes from.
class ImageRectifier {
 public:
  /// Empty if the pinhole camera has a pixel that the camera does not see.
  /// @param pinhole  in the same place, looking the same way
  static std::optional<ImageRectifier> make(const LensCamera& camera, const Camera& pinhole);

  int width() const { return width_; }    ///< of the images given
  int height() const { return height_; }  ///< of the images given

  /// Cubic interpolation (Catmull-Rom), clamped to the image at its border.
  /// @param image  of the camera's size; std::invalid_argument for another
  Image rectify(const Image& image) const;

 private:
  ImageRectifier(const LensCamera& camera, const Camera& pinhole);

  int width_, height_;
  int out_width_, out_height_;
  std::vector<Eigen::Vector2f> source_;  // a pixel each, by rows
};

}  // namespace fovea
