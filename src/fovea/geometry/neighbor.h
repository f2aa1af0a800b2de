#pragma once

#include <cstdint>

namespace fovea {

/// A point found near another.
struct Neighbor {
  std::uint32_t index = 0;
  float squared_distance = 0;  ///< m^2
};

}  // namespace fovea
