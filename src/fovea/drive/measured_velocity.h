// Velocities as navigation units measure them.
#pragma once

#include <optional>

#include "fovea/rigid_motion.h"

namespace fovea {

/// The twist (a second, in the body's frame) that a record states. None where it has zeros, as
/// drives have that were brought into a format from another, a number that is not finite, or what
/// no vehicle reaches: a unit that measures never says exactly zero, even at rest.
/// @param rate      rad/s, around the body's axes
/// @param velocity  m/s, along them
inline std::optional<Twist> measured_velocity(const Eigen::Vector3d& rate,
                                              const Eigen::Vector3d& velocity) {
  constexpr double kMaxTurnRate = 20, kMaxSpeed = 200;
  const auto is_measured = [](const Eigen::Vector3d& v, double most) {
    return !v.isZero(0) && v.norm() <= most;  // false of NaN
  };
  if (!is_measured(rate, kMaxTurnRate) || !is_measured(velocity, kMaxSpeed)) return std::nullopt;
  Twist twist;
  twist.head<3>() = rate;
  twist.tail<3>() = velocity;
  return twist;
}

}  // namespace fovea
