// Where points of a map lie in a camera's view: half the memory that floats would take, so that
// those of a view stay in the caches from when they are found to when they are coloured.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "fovea/base/steps.h"
#include "fovea/geometry/camera.h"

namespace fovea {

/// In the steps of the view.
struct PointInView {
  std::uint16_t u, v;   ///< pixel
  std::uint16_t depth;  ///< along the optical axis
  std::uint16_t place;  ///< which point it is
};

/// Steps of which 65,535 reach across the image and as far as points may lie: a fiftieth of a pixel
/// of 1,300 in a row, and a third of a millimetre of 20 m.
class ViewSteps {
 public:
  ViewSteps() = default;
  /// @param far  largest depth, m
  ViewSteps(const Camera& camera, double far)
      : pixel_(static_cast<float>(std::max(camera.width, camera.height)) / kMost),
        depth_(static_cast<float>(far) / kMost) {}

  /// What is out of reach becomes the nearest that is not.
  PointInView seen(const Eigen::Vector2f& pixel, float depth, std::uint16_t place) const {
    return {steps<std::uint16_t>(pixel.x(), pixel_), steps<std::uint16_t>(pixel.y(), pixel_),
            steps<std::uint16_t>(depth, depth_), place};
  }
  Eigen::Vector2f pixel(const PointInView& point) const {
    return {float(point.u) * pixel_, float(point.v) * pixel_};
  }
  float depth(const PointInView& point) const { return float(point.depth) * depth_; }  ///< m

 private:
  static constexpr float kMost = 65535;
  float pixel_ = 1, depth_ = 1;  // a step: pixels, m
};

}  // namespace fovea
