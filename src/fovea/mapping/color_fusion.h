// One color from many views (docs/method.md 6). The paper keeps one view.
#pragma once

#include <algorithm>
#include <cstdint>

#include "fovea/core/fused_color.h"

namespace fovea {

/// What one view shows of a point.
struct ColorSample {
  Eigen::Array3f code = Eigen::Array3f::Zero();  ///< in the reference exposure, not rounded
  std::uint16_t weight = 1;                      ///< 0: the view shows nothing of it
  std::uint8_t saturated = 0;                    ///< bits as in FusedColor

  /// For what may show another surface. It counts where the point has no other view.
  void trust_less() { weight = std::max<std::uint16_t>(1, weight / 16); }
};

/// Adds one view: weighted running mean and deviation of the codes (West 1979). A point without
/// views gets the color of the view.
/// @param random  bits for random rounding. Late views change a mean by less than a code, which
///                rounding to the nearest would lose.
void fuse(const ColorSample& seen, std::uint32_t random, FusedColor& point);

/// The color of one point from two disjoint sets of views (Chan, Golub and LeVeque 1979).
FusedColor fused(const FusedColor& a, const FusedColor& b);

}  // namespace fovea
