// What stands in front, as a camera sees it: the nearest depth by pixel of surface samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fovea/geometry/camera.h"
#include "fovea/mapping/view_places.h"

namespace fovea {

/// At half the image's resolution: what it decides is a matter of samples, not of pixels.
class DepthBuffer {
 public:
  /// A surface this far behind the front one is not taken for the same: metres, and share of depth.
  static constexpr float kBehind = 0.1f, kBehindShare = 0.02f;
  /// A point this far before it, and this share of its own depth, is not.
  static constexpr float kBefore = 0.3f, kBeforeShare = 0.05f;

  DepthBuffer() = default;  ///< of an image without pixels
  explicit DepthBuffer(const Camera& camera) { clear(camera); }

  /// Forgets all samples; the memory stays.
  void clear(const Camera& camera);

  /// Puts the first `count` samples of surfaces, inside the image, into the buffer.
  /// @param radius  of the surface that a sample stands for: pixels of the image, at a depth of 1 m
  void add(const ViewPlaces& samples, std::size_t count, float radius);

  /// Puts all samples of a buffer of the same camera into this one.
  void add(const DepthBuffer& other);

  /// Whether something added stands in front of a point there.
  bool hides(const Eigen::Vector2f& pixel, float depth) const {
    return is_behind(depth, depth_[place_of(pixel)]);
  }
  /// Which of the first `count` points nothing hides.
  /// @param visible  gets them, ascending
  /// @return how many
  std::size_t find_visible(const ViewPlaces& points, std::size_t count,
                           std::span<std::uint32_t, ViewPlaces::kSize> visible) const;

  /// Whether a point there would stand before all that was added: no part of its surface.
  bool stands_before(const Eigen::Vector2f& pixel, float depth) const {
    const float front = depth_[place_of(pixel)];
    return front != std::numeric_limits<float>::infinity() &&
           front - depth > std::max(kBefore, kBeforeShare * depth);
  }

 private:
  static bool is_behind(float depth, float front) {
    return depth > front + kBehind + kBehindShare * depth;
  }
  std::uint32_t place_of(const Eigen::Vector2f& pixel) const {
    const auto x = static_cast<int>(pixel.x() / 2 + 0.5f);
    const auto y = static_cast<int>(pixel.y() / 2 + 0.5f);
    return static_cast<std::uint32_t>(y * width_ + x);
  }
  int width_ = 0, height_ = 0;
  std::vector<float> depth_;
};

}  // namespace fovea
