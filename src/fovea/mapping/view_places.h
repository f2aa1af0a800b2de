// Places in a camera's view, a block at a time: each coordinate has a row of its own, on which the
// compiler works eight numbers at once.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "fovea/base/color_block.h"

namespace fovea {

struct ViewPlaces {
  static constexpr std::size_t kSize = ColorBlock::kSize;  ///< places of a block, at most
  std::array<float, kSize> u, v;                           ///< projection, pixels
  std::array<float, kSize> depth;                          ///< m along the optical axis
  void put(std::size_t i, const Eigen::Vector2f& pixel, float depth_of_place) {
    u[i] = pixel.x();
    v[i] = pixel.y();
    depth[i] = depth_of_place;
  }
};

}  // namespace fovea
