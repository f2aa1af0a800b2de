// Images and colours. Integer pixel coordinates are pixel CENTRES, everywhere (OpenCV, KITTI).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fovea/core/eigen_alignment.h"

namespace fovea {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Nearest 8-bit colour of a float colour (0-255 a channel, clamped).
Rgb to_rgb(const Eigen::Vector3f& color);
inline Eigen::Vector3f to_float(Rgb c) { return {float(c.r), float(c.g), float(c.b)}; }

/// Brightness of a color (ITU-R BT.601), 0-255; the common value of the channels of a gray one.
inline float luma(const Eigen::Vector3f& color) {
  return color.dot(Eigen::Vector3f(0.299f, 0.587f, 0.114f));
}

/// 8-bit image, rows from the top, channels interleaved; 1 (grey) or 3 (RGB) channels.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint8_t> data;  // height * width * channels

  Image() = default;
  Image(int width, int height, int channels);

  bool empty() const { return data.empty(); }
  const std::uint8_t* pixel(int x, int y) const {
    return data.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
  std::uint8_t* pixel(int x, int y) {
    return data.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
};

/// Colour at sub-pixel position (u, v), bilinear between the four pixel centres around it;
/// coordinates are clamped to the image. A grey image gives three equal channels (0-255).
Eigen::Vector3f bilinear(const Image& image, double u, double v);

}  // namespace fovea
