// Projections of a block of points: one array for each coordinate, so that loops vectorize.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "fovea/core/color_block.h"
#include "fovea/platform.h"

namespace fovea {

struct ProjectedPoints {
  static constexpr std::size_t kSize = ColorBlock::kSize;  ///< points of a block, at most
  std::array<float, kSize> u, v;                           ///< pixels
  std::array<float, kSize> depth;                          ///< m along the optical axis
  void put(std::size_t i, const Eigen::Vector2f& pixel, float depth_of_point) {
    u[i] = pixel.x();
    v[i] = pixel.y();
    depth[i] = depth_of_point;
  }
};

}  // namespace fovea
