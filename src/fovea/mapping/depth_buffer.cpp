#include "fovea/mapping/depth_buffer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fovea {
namespace {

/// Radius of a sample in the buffer's pixels: what lies on a pixel covers it, and no sample is near
/// enough to cover more than the larger.
constexpr float kMinRadius = 0.5f, kMaxRadius = 4.0f;

/// The pixels that samples cover, from the first to the last, along one axis.
struct Covered {
  using Row = std::array<float, ViewPlaces::kSize>;
  std::array<std::int32_t, ViewPlaces::kSize> first, last;
  void compute(const Row& place, const Row& depth, std::size_t count, float radius, int end) {
    for (std::size_t i = 0; i < count; ++i) {
      const float center = place[i] / 2;
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

void DepthBuffer::add(const ViewPlaces& samples, std::size_t count, float radius) {
  Covered columns, rows;
  columns.compute(samples.u, samples.depth, count, radius, width_);
  rows.compute(samples.v, samples.depth, count, radius, height_);
  float* const front = depth_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const float depth = samples.depth[i];
    const int left = columns.first[i], right = columns.last[i];
    float* const top = front + rows.first[i] * width_;
    float* const bottom = front + rows.last[i] * width_;
    if (right - left <= 1 && bottom - top <= width_) {
      // Nearly all samples: no loop, whose length nobody could foresee. A pixel may come twice, and
      // all are read first, for none to wait until another is written.
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

std::size_t DepthBuffer::find_visible(const ViewPlaces& points, std::size_t count,
                                      std::span<std::uint32_t, ViewPlaces::kSize> visible) const {
  // Where to look first, on which the compiler works eight wide.
  std::array<std::uint32_t, ViewPlaces::kSize> place;
  for (std::size_t i = 0; i < count; ++i) place[i] = place_of({points.u[i], points.v[i]});
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    visible[found] = i;
    found += !is_behind(points.depth[i], depth_[place[i]]);
  }
  return found;
}

void DepthBuffer::add(const DepthBuffer& other) {
  for (std::size_t i = 0; i < depth_.size(); ++i) depth_[i] = std::min(depth_[i], other.depth_[i]);
}

}  // namespace fovea
