#include "fovea/mapping/calibration/gray_plane.h"

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

/// Running means of 2 * radius + 1 values along rows of `count` values, `stride` apart. The first
/// and last value repeat beyond the ends.
void box_blur_lines(std::vector<float>& values, int lines, int line_stride, int count, int stride,
                    int radius) {
  std::vector<float> line(static_cast<std::size_t>(count));
  for (int l = 0; l < lines; ++l) {
    float* const first = values.data() + std::ptrdiff_t(l) * line_stride;
    for (int i = 0; i < count; ++i) line[std::size_t(i)] = first[std::ptrdiff_t(i) * stride];
    const auto at = [&](int i) { return line[std::size_t(std::clamp(i, 0, count - 1))]; };
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) sum += double(at(i));
    for (int i = 0; i < count; ++i) {
      first[std::ptrdiff_t(i) * stride] = static_cast<float>(sum / (2 * radius + 1));
      sum += double(at(i + radius + 1)) - double(at(i - radius));
    }
  }
}

}  // namespace

GrayPlane gray_plane(const Image& image, int factor) {
  GrayPlane gray{image.width / factor, image.height / factor, {}};
  for (int y = 0; y < gray.height; ++y) {
    for (int x = 0; x < gray.width; ++x) {
      float sum = 0;
      for (int dy = 0; dy < factor; ++dy) {
        for (int dx = 0; dx < factor; ++dx) {
          const std::uint8_t* p = image.pixel(x * factor + dx, y * factor + dy);
          sum += image.channels == 3 ? luma({float(p[0]), float(p[1]), float(p[2])}) : float(p[0]);
        }
      }
      gray.values.push_back(sum / float(factor * factor));
    }
  }
  return gray;
}

GrayPlane box_blurred(GrayPlane plane, int radius) {
  if (radius < 1) return plane;
  box_blur_lines(plane.values, plane.height, plane.width, plane.width, 1, radius);
  box_blur_lines(plane.values, plane.width, 1, plane.height, plane.width, radius);
  return plane;
}

GrayPlane smoothed(GrayPlane plane, double sigma) {
  const int radius = std::max(1, static_cast<int>(std::lround(1.22 * sigma)));
  return box_blurred(box_blurred(std::move(plane), radius), radius);
}

}  // namespace fovea
