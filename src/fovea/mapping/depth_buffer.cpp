#include "fovea/mapping/depth_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fovea {
namespace {
/// Radius of a sample in the buffer's pixels: what lies on a pixel covers it, and no sample is near
/// enough to cover more than the larger.
constexpr float kMinRadius = 0.5f, kMaxRadius = 4.0f;
}  // namespace

DepthBuffer::DepthBuffer(const Camera& camera)
    : width_(camera.width / 2 + 1),
      height_(camera.height / 2 + 1),
      depth_(static_cast<std::size_t>(width_) * height_, std::numeric_limits<float>::infinity()) {}

void DepthBuffer::add(const Eigen::Vector2f& pixel, float depth, float radius) {
  const float u = pixel.x() / 2, v = pixel.y() / 2;
  const float r = std::clamp(radius / 2, kMinRadius, kMaxRadius);
  const int left = std::max(0, static_cast<int>(std::ceil(u - r)));
  const int right = std::min(width_ - 1, static_cast<int>(std::floor(u + r)));
  const int top = std::max(0, static_cast<int>(std::ceil(v - r)));
  const int bottom = std::min(height_ - 1, static_cast<int>(std::floor(v + r)));
  for (int y = top; y <= bottom; ++y) {
    float* row = depth_.data() + static_cast<std::size_t>(y) * width_;
    for (int x = left; x <= right; ++x) row[x] = std::min(row[x], depth);
  }
}

float DepthBuffer::depth_at(const Eigen::Vector2f& pixel) const {
  const auto x = static_cast<std::size_t>(pixel.x() / 2 + 0.5f);
  const auto y = static_cast<std::size_t>(pixel.y() / 2 + 0.5f);
  return depth_[y * static_cast<std::size_t>(width_) + x];
}

bool DepthBuffer::hides(const Eigen::Vector2f& pixel, float depth) const {
  return depth > depth_at(pixel) + kBehind + kBehindShare * depth;
}

bool DepthBuffer::stands_before(const Eigen::Vector2f& pixel, float depth) const {
  const float front = depth_at(pixel);
  return front != std::numeric_limits<float>::infinity() &&
         front - depth > std::max(kBefore, kBeforeShare * depth);
}

}  // namespace fovea
