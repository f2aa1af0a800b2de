// Where a point comes from, as the viewer's page is told (docs/viewer-protocol.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fovea/base/angle.h"

namespace fovea {

/// A value in steps, or 65535 if it is unknown (NaN or negative).
inline std::uint16_t steps_of(double value, double step) {
  constexpr double kUnknown = 65535;
  if (!(value >= 0)) return static_cast<std::uint16_t>(kUnknown);
  return static_cast<std::uint16_t>(std::min(std::round(value / step), kUnknown - 1));
}

/// Range in centimetres, and incidence in hundredths of a degree.
inline std::uint16_t sight_range(float range) { return steps_of(range, 0.01); }
inline std::uint16_t sight_incidence(float incidence) {
  return steps_of(incidence / kDegree, 0.01);
}

/// The rule, whether the colour's exposure was matched, and whether the point is interpolated.
inline std::uint8_t rule_byte(std::uint8_t reason, bool interpolated) {
  constexpr int kInterpolated = 0x80;
  return static_cast<std::uint8_t>(reason | (interpolated ? kInterpolated : 0));
}

}  // namespace fovea
