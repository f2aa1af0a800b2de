// Quantized projections of map points into a camera. They take half the memory of floats, so that
// the points of a view stay in the caches between rendering and coloring.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "fovea/camera.h"
#include "fovea/core/steps.h"

namespace fovea {

/// In the steps of a ViewQuantizer.
struct PointInView {
  std::uint16_t u, v;   ///< pixel
  std::uint16_t depth;  ///< along the optical axis
  std::uint16_t index;  ///< of the point in its chunk
};

/// 65,535 steps cover the image, and the depths of a view. For an image 1,300 pixels wide a step is
/// a fiftieth of a pixel; for depths up to 20 m it is a third of a millimeter.
class ViewQuantizer {
 public:
  ViewQuantizer() = default;
  /// @param far  largest depth, m
  ViewQuantizer(const Camera& camera, double far)
      : pixel_(static_cast<float>(std::max(camera.width, camera.height)) / kMaxStep),
        depth_(static_cast<float>(far) / kMaxStep) {}

  /// Clamps values that are out of range.
  PointInView quantize(const Eigen::Vector2f& pixel, float depth, std::uint16_t index) const {
    return {steps<std::uint16_t>(pixel.x(), pixel_), steps<std::uint16_t>(pixel.y(), pixel_),
            steps<std::uint16_t>(depth, depth_), index};
  }
  Eigen::Vector2f pixel(const PointInView& point) const {
    return {float(point.u) * pixel_, float(point.v) * pixel_};
  }
  float depth(const PointInView& point) const { return float(point.depth) * depth_; }  ///< m

 private:
  static constexpr float kMaxStep = 65535;
  float pixel_ = 1, depth_ = 1;  // a step: pixels, m
};

}  // namespace fovea
