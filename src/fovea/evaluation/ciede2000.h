// Colour differences as people see them: CIEDE2000 (Sharma, Wu, Dalal 2005, "The CIEDE2000
// color-difference formula: implementation notes, supplementary test data, and mathematical
// observations", Color Research and Application 30).
#pragma once

#include <Eigen/Core>

#include "fovea/platform.h"

namespace fovea {

/// CIE L*a*b* under D65, 2 degrees.
struct Lab {
  double l = 0, a = 0, b = 0;
};

/// @param color  sRGB (IEC 61966-2-1), 0-255 a channel, fractions allowed, clamped
Lab lab_of(const Eigen::Vector3f& color);

/// Difference of two colours, all weights 1: about 1 is just noticeable, black to white 100.
double ciede2000(const Lab& first, const Lab& second);

}  // namespace fovea
