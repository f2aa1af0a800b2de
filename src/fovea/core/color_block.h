// Colors of some points, a row for each channel, on which the compiler works eight at a time.
#pragma once

#include <array>
#include <cstddef>

#include "fovea/platform.h"

namespace fovea {

/// Eigen's functions round aligned floats otherwise than unaligned ones. Rows are therefore always
/// aligned: a color does not depend on the place of the block on the stack.
struct ColorBlock {
  static constexpr std::size_t kSize = 256;
  alignas(EIGEN_MAX_ALIGN_BYTES) std::array<float, kSize> red, green, blue;  ///< 0-255
};

}  // namespace fovea
