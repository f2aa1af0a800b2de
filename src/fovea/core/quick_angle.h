// Arc tangent by a polynomial. Compilers vectorize loops over it, which they cannot do with
// std::atan2.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fovea {

/// std::atan2(y, x) of finite numbers, with an error below 1e-6 rad; 0 for (0, 0).
inline float quick_atan2(float y, float x) {
  const float a = std::abs(x), b = std::abs(y);
  const float t = std::min(a, b) / (std::max(a, b) + std::numeric_limits<float>::min());
  const float s = t * t;
  // Minimax polynomial of degree 13 for the arc tangent on [0, 1].
  const float eighth =
      t * (0.9999961f +
           s * (-0.3331738f +
                s * (0.1980786f +
                     s * (-0.1323335f + s * (0.0796255f + s * (-0.0336058f + s * 0.0068118f))))));
  // Selections instead of branches.
  const float turned = std::numbers::pi_v<float> / 2 - eighth;
  const float quarter = b > a ? turned : eighth;
  const float mirrored = std::numbers::pi_v<float> - quarter;
  return std::copysign(x < 0 ? mirrored : quarter, y);
}

}  // namespace fovea
