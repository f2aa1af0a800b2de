#include "fovea/mapping/depth_buffer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fovea {
namespace {

/// Bounds of a sample's radius, in the buffer's pixels.
constexpr float kMinRadius = 0.5f, kMaxRadius = 4.0f;

/// First and last pixel that each sample covers along one axis.
struct CoveredRange {
  using Row = std::array<float, ProjectedPoints::kSize>;
  std::array<std::int32_t, ProjectedPoints::kSize> first, last;
  void compute(const Row& position, const Row& depth, std::size_t count, float radius, int end) {
    for (std::size_t i = 0; i < count; ++i) {
      const float center = position[i] / 2;
      const float r = std::min(std::max(radius / depth[i] / 2, kMinRadius), kMaxRadius);
      first[i] = std::max(0, static_cast<std::int32_t>(std::ceil(center - r)));
      last[i] = std::min(end - 1, static_cast<std::int32_t>(std::floor(center + r)));
    }
  }
};

}  // namespace

void DepthBuffer::clear(const Camera& camera) {
  width_ = camera.width / 2 + 1;
  height_ = camera.height / 2 + 1;
  depth_.assign(static_cast<std::size_t>(width_) * height_, std::numeric_limits<float>::infinity());
}

void DepthBuffer::add(const ProjectedPoints& samples, std::size_t count, float radius) {
  CoveredRange columns, rows;
  columns.compute(samples.u, samples.depth, count, radius, width_);
  rows.compute(samples.v, samples.depth, count, radius, height_);
  float* const front = depth_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const float depth = samples.depth[i];
    const int left = columns.first[i], right = columns.last[i];
    float* const top = front + rows.first[i] * width_;
    float* const bottom = front + rows.last[i] * width_;
    if (right - left <= 1 && bottom - top <= width_) {
      // At most 2 x 2 pixels, the usual case: no loop, and all reads before all writes. Two of the
      // four pixels may be the same.
      const float a = std::min(top[left], depth), b = std::min(top[right], depth);
      const float c = std::min(bottom[left], depth), d = std::min(bottom[right], depth);
      top[left] = a;
      top[right] = b;
      bottom[left] = c;
      bottom[right] = d;
      continue;
    }
    for (float* row = top; row <= bottom; row += width_) {
      for (int x = left; x <= right; ++x) row[x] = std::min(row[x], depth);
    }
  }
}

std::size_t DepthBuffer::find_visible(
    const ProjectedPoints& points, std::size_t count,
    std::span<std::uint32_t, ProjectedPoints::kSize> visible) const {
  std::array<std::uint32_t, ProjectedPoints::kSize> cell;
  for (std::size_t i = 0; i < count; ++i) cell[i] = cell_of({points.u[i], points.v[i]});
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    visible[found] = i;
    found += !is_behind(points.depth[i], depth_[cell[i]]);
  }
  return found;
}

void DepthBuffer::add(const DepthBuffer& other) {
  for (std::size_t i = 0; i < depth_.size(); ++i) depth_[i] = std::min(depth_[i], other.depth_[i]);
}

}  // namespace fovea
