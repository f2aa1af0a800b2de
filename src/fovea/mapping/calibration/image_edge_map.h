// How near an image's edges are to each of its pixels, at several smoothings.
#pragma once

#include <array>
#include <vector>

#include "fovea/image.h"

namespace fovea {

/// The logarithm of the strength of edges around a pixel, less its mean over the image. Edges are
/// compared with their neighborhood, so that foliage does not outweigh a plain wall's corner.
class ImageEdgeMap {
 public:
  /// Standard deviations of the smoothing, rad in the image's center: coarse to fine.
  static constexpr std::array<double, 4> kWidths{0.035, 0.0175, 0.0087, 0.0044};
  static constexpr int kLevels = int(kWidths.size());

  /// @param focal  pixels
  ImageEdgeMap(const Image& image, double focal);

  /// 0 outside the image.
  /// @param upright  share of upright edges in the result, the others are level; 0 to 1
  float at(int level, float u, float v, float upright) const {
    if (!(u >= 0 && v >= 0 && u < 1e6f && v < 1e6f)) return 0;
    const auto x = static_cast<int>((u + 0.5f) * scale_), y = static_cast<int>((v + 0.5f) * scale_);
    if (x >= width_ || y >= height_) return 0;
    const std::size_t pixel = std::size_t(y) * std::size_t(width_) + std::size_t(x);
    const auto& of_level = levels_[std::size_t(level)];
    return upright * of_level[0][pixel] + (1 - upright) * of_level[1][pixel];
  }

 private:
  int width_ = 0, height_ = 0;
  float scale_ = 1;  // pixels of the map per pixel of the image
  std::array<std::array<std::vector<float>, 2>, kLevels> levels_;  // upright, level edges
};

}  // namespace fovea
