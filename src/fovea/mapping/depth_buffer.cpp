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
  is_doubtful_.assign(depth_.size(), 0);
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

void DepthBuffer::find_edges() {
  const auto width = static_cast<std::size_t>(width_), size = depth_.size();
  // The range of depths in each cell and its neighbors: along the rows, then along the columns.
  std::vector<float> low(size), high(size);
  for (std::size_t i = 0; i < size; ++i) {
    const float before = depth_[i > 0 ? i - 1 : i], after = depth_[i + 1 < size ? i + 1 : i];
    low[i] = std::min({before, depth_[i], after});
    high[i] = std::max({before, depth_[i], after});
  }
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t above = i >= width ? i - width : i, below = i + width < size ? i + width : i;
    const float nearest = std::min({low[above], low[i], low[below]});
    const float farthest = std::max({high[above], high[i], high[below]});
    is_doubtful_[i] = farthest > nearest + std::max(kBefore, kBeforeShare * nearest) ? 1 : 0;
  }
}

void DepthBuffer::doubt(const Eigen::Vector2f& pixel, float radius) {
  const Eigen::Vector2f center = pixel / 2;
  const float r = radius / 2;
  const int top = std::max(0, static_cast<int>(std::ceil(center.y() - r)));
  const int bottom = std::min(height_ - 1, static_cast<int>(std::floor(center.y() + r)));
  for (int y = top; y <= bottom; ++y) {
    const float half =
        std::sqrt(std::max(0.0f, r * r - (float(y) - center.y()) * (float(y) - center.y())));
    const int left = std::max(0, static_cast<int>(std::ceil(center.x() - half)));
    const int right = std::min(width_ - 1, static_cast<int>(std::floor(center.x() + half)));
    for (int x = left; x <= right; ++x)
      is_doubtful_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] = 1;
  }
}

void DepthBuffer::add(const DepthBuffer& other) {
  for (std::size_t i = 0; i < depth_.size(); ++i) depth_[i] = std::min(depth_[i], other.depth_[i]);
}

}  // namespace fovea
