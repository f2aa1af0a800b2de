#include "fovea/mapping/image_pyramid.h"

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

constexpr std::size_t kLevels = 6;  // the last one's pixels are 32 pixels wide

/// Means of 2 x 2 pixels; an odd last row or column is left out.
Image halved(const Image& image) {
  Image half(image.width / 2, image.height / 2, image.channels);
  for (int y = 0; y < half.height; ++y) {
    const std::uint8_t *above = image.pixel(0, 2 * y), *below = image.pixel(0, 2 * y + 1);
    std::uint8_t* out = half.pixel(0, y);
    for (int x = 0; x < half.width; ++x) {
      const int left = 2 * x * image.channels, right = left + image.channels;
      for (int c = 0; c < image.channels; ++c) {
        *out++ = static_cast<std::uint8_t>(
            (above[left + c] + above[right + c] + below[left + c] + below[right + c] + 2) / 4);
      }
    }
  }
  return half;
}

}  // namespace

ImagePyramid::ImagePyramid(const Image& image) {
  levels_.push_back(image);
  while (levels_.size() < kLevels && std::min(levels_.back().width, levels_.back().height) >= 2) {
    levels_.push_back(halved(levels_.back()));
  }
}

Eigen::Vector3f ImagePyramid::at_level(std::size_t level, double u, double v) const {
  const double scale = 1.0 / static_cast<double>(std::size_t{1} << level);
  return bilinear(levels_[level], (u + 0.5) * scale - 0.5, (v + 0.5) * scale - 0.5);
}

Eigen::Vector3f ImagePyramid::at(double u, double v, float footprint) const {
  const float top = static_cast<float>(levels_.size() - 1);
  const float level = std::clamp(std::log2(std::max(footprint, 1.0f)), 0.0f, top);
  const auto fine = static_cast<std::size_t>(level);
  const float share = level - static_cast<float>(fine);
  if (share == 0) return at_level(fine, u, v);
  return (1 - share) * at_level(fine, u, v) + share * at_level(fine + 1, u, v);
}

}  // namespace fovea
