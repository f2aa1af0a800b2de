// Sharpness (docs/method.md 7): how much of the photograph's detail the map has. Colour errors
// cannot see it: a blur of one pixel "improves" TE.
#pragma once

#include "fovea/rendering/splat.h"

namespace fovea {

/// Sums of image gradient magnitudes over the pixels that could be compared.
struct GradientSums {
  std::size_t pixels = 0;
  double map = 0, photograph = 0;
  double products = 0, squares = 0;  ///< of the map's gradient with the photograph's; of the latter

  GradientSums& operator+=(const GradientSums& other);
  /// Mean gradient of the drawn map over the photograph's: 1 as sharp, less blurred, more noisy;
  /// NaN if nothing could be compared.
  double sharpness() const;
  /// Share of the photograph's detail that the map repeats: the slope of the regression of the
  /// map's gradient vectors on the photograph's. Noise, which adds to sharpness, adds nothing here:
  /// 1 as sharp, less blurred or out of place; NaN if nothing could be compared.
  double detail() const;
};

/// Compares a drawn map with the photograph taken there. The gradient is that of the luma (0-255 a
/// pixel) by differences to the right and lower neighbour. A pixel counts if all three are drawn
/// and their depths lie within 5%, so that no outline of a hole or an object counts. Exposures are
/// compared as they are: a map half as bright has half the sharpness.
GradientSums compare_gradients(const SplatView& drawn, const Image& photograph);

}  // namespace fovea
