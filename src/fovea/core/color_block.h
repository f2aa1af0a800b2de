// Colours of some points, a row for each channel, on which the compiler works eight at a time.
#pragma once

#include <array>
#include <cstddef>

namespace fovea {

struct ColorBlock {
  static constexpr std::size_t kSize = 256;
  std::array<float, kSize> red, green, blue;  ///< 0-255
};

}  // namespace fovea
