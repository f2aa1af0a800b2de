// What stands in front, as a camera sees it: the nearest depth by pixel of surface samples.
#pragma once

#include <vector>

#include "fovea/geometry/camera.h"

namespace fovea {

/// At half the image's resolution: what it decides is a matter of samples, not of pixels.
class DepthBuffer {
 public:
  /// A surface this far behind the front one is not taken for the same: metres, and share of depth.
  static constexpr float kBehind = 0.1f, kBehindShare = 0.02f;
  /// A point this far before it, and this share of its own depth, is not.
  static constexpr float kBefore = 0.3f, kBeforeShare = 0.05f;

  explicit DepthBuffer(const Camera& camera);

  /// Puts a sample into the buffer.
  /// @param pixel   projection, inside the image
  /// @param depth   m along the optical axis
  /// @param radius  of the surface that the sample stands for, pixels of the image
  void add(const Eigen::Vector2f& pixel, float depth, float radius);

  /// Whether something added stands in front of a point there.
  bool hides(const Eigen::Vector2f& pixel, float depth) const;

  /// Whether a point there would stand before all that was added: no part of its surface.
  bool stands_before(const Eigen::Vector2f& pixel, float depth) const;

 private:
  float depth_at(const Eigen::Vector2f& pixel) const;
  int width_, height_;
  std::vector<float> depth_;
};

}  // namespace fovea
