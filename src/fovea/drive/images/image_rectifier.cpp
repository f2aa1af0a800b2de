#include "fovea/drive/images/image_rectifier.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr std::size_t kRows = 16;  // at a time

/// Weights of the four samples round a place `t` of the way from the second to the third.
/// R. Keys, Cubic convolution interpolation for digital image processing, 1981 (a = -1/2).
std::array<float, 4> cubic_weights(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {0.5f * (-t + 2 * t2 - t3), 0.5f * (2 - 5 * t2 + 3 * t3), 0.5f * (t + 4 * t2 - 3 * t3),
          0.5f * (t3 - t2)};
}

template <int kChannels>
void resample(const Image& image, const Eigen::Vector2f& place, std::uint8_t* out) {
  const auto left = static_cast<int>(place.x()), top = static_cast<int>(place.y());
  const std::array<float, 4> across = cubic_weights(place.x() - static_cast<float>(left)),
                             down = cubic_weights(place.y() - static_cast<float>(top));
  std::array<int, 4> column;
  for (int i = 0; i < 4; ++i) column[std::size_t(i)] = std::clamp(left + i - 1, 0, image.width - 1);
  std::array<float, kChannels> sum{};
  for (int j = 0; j < 4; ++j) {
    const std::uint8_t* row = image.pixel(0, std::clamp(top + j - 1, 0, image.height - 1));
    for (std::size_t c = 0; c < kChannels; ++c) {
      float of_row = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        of_row += across[i] * static_cast<float>(row[std::size_t(column[i]) * kChannels + c]);
      }
      sum[c] += down[std::size_t(j)] * of_row;
    }
  }
  for (std::size_t c = 0; c < kChannels; ++c) {
    out[c] = static_cast<std::uint8_t>(std::clamp(sum[c], 0.0f, 255.0f) + 0.5f);
  }
}

}  // namespace

ImageRectifier::ImageRectifier(const LensCamera& camera, const Camera& pinhole)
    : width_(camera.width),
      height_(camera.height),
      out_width_(pinhole.width),
      out_height_(pinhole.height),
      source_(static_cast<std::size_t>(pinhole.width) * static_cast<std::size_t>(pinhole.height)) {}

std::optional<ImageRectifier> ImageRectifier::make(const LensCamera& camera,
                                                   const Camera& pinhole) {
  ImageRectifier rectifier(camera, pinhole);
  std::atomic<bool> all_seen = true;
  parallel_for(static_cast<std::size_t>(pinhole.height), kRows, [&](std::size_t v) {
    Eigen::Vector2f* source =
        rectifier.source_.data() + v * static_cast<std::size_t>(pinhole.width);
    for (int u = 0; u < pinhole.width; ++u) {
      const Eigen::Vector3d ray((u - pinhole.cx) / pinhole.fx,
                                (static_cast<double>(v) - pinhole.cy) / pinhole.fy, 1);
      const auto pixel = camera.project(ray);
      if (!pixel || !camera.in_view(*pixel)) {
        all_seen = false;
        return;
      }
      source[u] = pixel->cast<float>();
    }
  });
  if (!all_seen) return std::nullopt;
  return rectifier;
}

Image ImageRectifier::rectify(const Image& image) const {
  if (image.width != width_ || image.height != height_) {
    throw std::invalid_argument("the image is not of the camera's size");
  }
  Image out(out_width_, out_height_, image.channels);
  parallel_for(static_cast<std::size_t>(out_height_), kRows, [&](std::size_t v) {
    const Eigen::Vector2f* source = source_.data() + v * static_cast<std::size_t>(out_width_);
    for (int u = 0; u < out_width_; ++u) {
      std::uint8_t* pixel = out.pixel(u, static_cast<int>(v));
      if (image.channels == 1) {
        resample<1>(image, source[u], pixel);
      } else {
        resample<3>(image, source[u], pixel);
      }
    }
  });
  return out;
}

}  // namespace fovea
