// Where a point comes from, as the viewer's page is told (docs/viewer-protocol.md).
#pragma once

#include <algorithm>
#include <cstdint>

#include "fovea/core/angle.h"

namespace fovea {

/// A value in whole steps, or 65535 if it is unknown (NaN or negative).
inline std::uint16_t steps_of(float value, float steps_per_unit) {
  constexpr float kUnknown = 65535;
  if (!(value >= 0)) return static_cast<std::uint16_t>(kUnknown);
  return static_cast<std::uint16_t>(std::min(value * steps_per_unit + 0.5f, kUnknown - 1));
}

/// Range in centimetres, and incidence in hundredths of a degree.
inline std::uint16_t sight_range(float range) { return steps_of(range, 100); }
inline std::uint16_t sight_incidence(float incidence) {
  return steps_of(incidence, static_cast<float>(100 / kDegree));
}

/// The rule, whether the colour's exposure was matched, and whether the point is interpolated.
inline std::uint8_t rule_byte(std::uint8_t reason, bool interpolated) {
  constexpr int kInterpolated = 0x80;
  return static_cast<std::uint8_t>(reason | (interpolated ? kInterpolated : 0));
}

}  // namespace fovea
