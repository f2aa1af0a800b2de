// An image at halved resolutions: colours of patches, not of points (Williams 1983).
#pragma once

#include <vector>

#include "fovea/base/image.h"

namespace fovea {

class ImagePyramid {
 public:
  explicit ImagePyramid(const Image& image);

  /// Mean colour (0-255 a channel) of about `footprint` x `footprint` pixels around (u, v), linear
  /// between levels; bilinear in the image itself where the footprint is 1 or less.
  Eigen::Vector3f at(double u, double v, float footprint) const;

 private:
  Eigen::Vector3f at_level(std::size_t level, double u, double v) const;
  std::vector<Image> levels_;  // each half as wide and high as the one before
};

}  // namespace fovea
