// What no vehicle's numbers exceed: a file with larger ones is damaged, or has other units.
#pragma once

#include <cmath>

namespace fovea {

/// m, between two parts of a vehicle; a larger distance is likely in millimeters.
inline constexpr double kMaxLever = 20;
inline constexpr double kMaxAltitude = 20'000;  ///< m, either way
inline constexpr double kMaxAngle = 7;          ///< rad: a full turn and some rounding
/// Of a rotation's matrix, which files round.
inline constexpr double kRotationTolerance = 1e-3;

/// Whether this (degrees) is the 0, 0 that receivers state without a fix: no land is near.
inline bool is_null_position(double latitude, double longitude) {
  constexpr double kNear = 1e-3;  // degrees: 110 m
  return std::abs(latitude) < kNear && std::abs(longitude) < kNear;
}

}  // namespace fovea
