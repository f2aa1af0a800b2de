// The nearest depth of surface samples in each pixel of a camera.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fovea/camera.h"
#include "fovea/mapping/projected_points.h"

namespace fovea {

/// Has half the image's resolution, since the spacing of samples limits it, not that of pixels.
class DepthBuffer {
 public:
  /// Meters and share of depth that a point must lie behind the front surface to be hidden.
  static constexpr float kBehind = 0.1f, kBehindShare = 0.02f;
  /// Meters and share of its depth that a point must lie before the front surface to be in front.
  static constexpr float kBefore = 0.3f, kBeforeShare = 0.05f;

  DepthBuffer() = default;  ///< of an image without pixels
  explicit DepthBuffer(const Camera& camera) { clear(camera); }

  /// Removes all samples and keeps the memory.
  void clear(const Camera& camera);

  /// Adds the first `count` surface samples, all inside the image.
  /// @param radius  of a sample's disc: pixels of the image, at a depth of 1 m
  void add(const ProjectedPoints& samples, std::size_t count, float radius);

  /// Adds all samples of a buffer of the same camera.
  void add(const DepthBuffer& other);

  /// Marks the edges of depth as doubtful, where a pixel may show another surface: where a depth
  /// within about a pixel differs from another there as in is_in_front(), or is unknown. To be
  /// called after all samples are added.
  void find_edges();
  /// Marks the pixels around one as doubtful, too.
  void doubt(const Eigen::Vector2f& pixel, float radius);
  bool is_doubtful(const Eigen::Vector2f& pixel) const { return is_doubtful_[cell_of(pixel)] != 0; }

  /// Whether an added surface hides a point.
  bool hides(const Eigen::Vector2f& pixel, float depth) const {
    return is_behind(depth, depth_[cell_of(pixel)]);
  }
  /// Finds those of the first `count` points that no surface hides.
  /// @param visible  gets their indices, ascending
  /// @return their number
  std::size_t find_visible(const ProjectedPoints& points, std::size_t count,
                           std::span<std::uint32_t, ProjectedPoints::kSize> visible) const;

  /// Whether a point lies in front of the added surfaces, and is no part of them.
  /// @param farthest  depth of surfaces that count, m
  bool is_in_front(const Eigen::Vector2f& pixel, float depth, float farthest) const {
    const float front = depth_[cell_of(pixel)];
    return front < farthest && front - depth > std::max(kBefore, kBeforeShare * depth);
  }

 private:
  static bool is_behind(float depth, float front) {
    return depth > front + kBehind + kBehindShare * depth;
  }
  std::uint32_t cell_of(const Eigen::Vector2f& pixel) const {
    const auto x = static_cast<int>(pixel.x() / 2 + 0.5f);
    const auto y = static_cast<int>(pixel.y() / 2 + 0.5f);
    return static_cast<std::uint32_t>(y * width_ + x);
  }
  int width_ = 0, height_ = 0;
  std::vector<float> depth_;
  std::vector<std::uint8_t> is_doubtful_;
};

}  // namespace fovea
