// Angles are radians; what a user writes and reads is in degrees.
#pragma once

#include <numbers>

namespace fovea {

/// One degree (rad).
inline constexpr double kDegree = std::numbers::pi / 180;

}  // namespace fovea
