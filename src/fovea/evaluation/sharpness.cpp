#include "fovea/evaluation/sharpness.h"

#include <cmath>
#include <stdexcept>

#include "fovea/evaluation/metrics.h"

namespace fovea {
namespace {

constexpr float kLikeDepth = 0.05f;  // relative; ground at 15 m deepens by 1.3% a pixel

float luma_at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return image.channels == 1 ? static_cast<float>(p[0]) : luma(Eigen::Vector3f(p[0], p[1], p[2]));
}

Eigen::Vector2d gradient_at(const Image& image, int x, int y) {
  const float here = luma_at(image, x, y);
  return {luma_at(image, x + 1, y) - here, luma_at(image, x, y + 1) - here};
}

}  // namespace

GradientSums& GradientSums::operator+=(const GradientSums& other) {
  pixels += other.pixels;
  map += other.map;
  photograph += other.photograph;
  products += other.products;
  squares += other.squares;
  return *this;
}

double GradientSums::sharpness() const {
  if (!(photograph > 0)) return std::numeric_limits<double>::quiet_NaN();
  return map / photograph;
}

double GradientSums::detail() const {
  if (!(squares > 0)) return std::numeric_limits<double>::quiet_NaN();
  return products / squares;
}

GradientSums compare_gradients(const SplatView& drawn, const Image& photograph) {
  const int width = drawn.image.width, height = drawn.image.height;
  if (photograph.width != width || photograph.height != height) {
    throw std::invalid_argument("the drawn map and the photograph differ in size");
  }
  GradientSums sums;
  for (int y = 0; y + 1 < height; ++y) {
    for (int x = 0; x + 1 < width; ++x) {
      const std::size_t here = static_cast<std::size_t>(y) * width + x;
      const auto like_here = [&](std::size_t neighbor) {
        return drawn.covered[neighbor] != 0 &&
               std::abs(drawn.depth[neighbor] - drawn.depth[here]) <=
                   kLikeDepth * drawn.depth[here];
      };
      if (drawn.covered[here] == 0 || !like_here(here + 1) || !like_here(here + width)) continue;
      ++sums.pixels;
      const Eigen::Vector2d map = gradient_at(drawn.image, x, y);
      const Eigen::Vector2d photo = gradient_at(photograph, x, y);
      sums.map += map.norm();
      sums.photograph += photo.norm();
      sums.products += map.dot(photo);
      sums.squares += photo.squaredNorm();
    }
  }
  return sums;
}

}  // namespace fovea
