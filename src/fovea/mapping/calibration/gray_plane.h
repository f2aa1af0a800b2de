// A gray image with float values, and its smoothing.
#pragma once

#include <vector>

#include "fovea/image.h"

namespace fovea {

struct GrayPlane {
  int width = 0, height = 0;
  std::vector<float> values;  ///< rows from the top

  float at(int x, int y) const {
    return values[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

/// Brightness (0-255), means of blocks of `factor` x `factor` pixels.
GrayPlane gray_plane(const Image& image, int factor = 1);

/// Means of (2 * radius + 1)^2 pixels. Values repeat beyond the border.
GrayPlane box_blurred(GrayPlane plane, int radius);

/// Two box blurs with about the standard deviation of a Gaussian.
/// @param sigma  pixels
GrayPlane smoothed(GrayPlane plane, double sigma);

}  // namespace fovea
