#include "fovea/image.h"

#include <algorithm>
#include <cmath>

namespace fovea {

Rgb to_rgb(const Eigen::Vector3f& color) {
  const auto channel = [](float value) {
    return static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
  };
  return {channel(color.x()), channel(color.y()), channel(color.z())};
}

Image::Image(int width_, int height_, int channels_)
    : width(width_),
      height(height_),
      channels(channels_),
      data(static_cast<std::size_t>(width_) * height_ * channels_) {}

Eigen::Vector3f bilinear(const Image& image, double u, double v) {
  const double x = std::clamp(u, 0.0, image.width - 1.0);
  const double y = std::clamp(v, 0.0, image.height - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const auto sample = [&](int px, int py) -> Eigen::Vector3f {
    const std::uint8_t* p = image.pixel(px, py);
    return image.channels == 3 ? Eigen::Vector3f(p[0], p[1], p[2])
                               : Eigen::Vector3f::Constant(p[0]);
  };
  return (1 - fy) * ((1 - fx) * sample(x0, y0) + fx * sample(x1, y0)) +
         fy * ((1 - fx) * sample(x0, y1) + fx * sample(x1, y1));
}

}  // namespace fovea
