#include <algorithm>
#include <cmath>

#include "fovea/image.h"

namespace fovea {

ImageMask::ImageMask(const Image& picture)
    : width_(picture.width),
      height_(picture.height),
      masked_before_(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height_ + 1)) {
  constexpr std::uint8_t kLight = 128;
  for (int y = 0; y < height_; ++y) {
    std::uint32_t in_row = 0;
    for (int x = 0; x < width_; ++x) {
      const std::uint8_t* pixel = picture.pixel(x, y);
      in_row += *std::min_element(pixel, pixel + picture.channels) < kLight;
      masked_before(x + 1, y + 1) = masked_before(x + 1, y) + in_row;
    }
  }
}

bool ImageMask::covers(float u, float v, float half) const {
  const auto clamped = [](float at, int end) {
    return static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(end)));
  };
  const int left = clamped(std::floor(u - half + 0.5f), width_);
  const int right = clamped(std::floor(u + half + 0.5f) + 1, width_);
  const int top = clamped(std::floor(v - half + 0.5f), height_);
  const int bottom = clamped(std::floor(v + half + 0.5f) + 1, height_);
  const auto before = [&](int x, int y) { return masked_before_[place(x, y)]; };
  return before(right, bottom) + before(left, top) != before(left, bottom) + before(right, top);
}

std::uint32_t ImageMask::fingerprint() const {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  for (const std::uint32_t count : masked_before_) {
    for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (count >> shift & 0xff)) * 16777619u;
  }
  return hash;
}

}  // namespace fovea
