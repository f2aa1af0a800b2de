// How a body moves while a scan is taken: not quite steadily.
#pragma once

#include <optional>
#include <vector>

#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Where a body was at even steps of time, as measured by an IMU.
struct SweepPath {
  double begin = 0;               ///< s from the moment to the first place
  double step = 0;                ///< s from place to place
  std::vector<Twist> placements;  ///< rotation vector (rad) and translation (m); two or more

  /// From the body `dt` (s) after the moment to the body at the moment. Beyond the ends the first
  /// or the last step goes on.
  RigidMotion at(double dt) const;

  bool operator==(const SweepPath&) const = default;
};

/// How a body moves about a moment.
struct SweepMotion {
  Twist velocity = Twist::Zero();                ///< of the body in its own frame, a second
  Twist acceleration = Twist::Zero();            ///< the velocity's change, a second squared
  std::optional<SweepPath> path = std::nullopt;  ///< absent: the two above tell the motion

  /// Twist from where it is at the moment to where it is `dt` (s) later, or earlier. What the two
  /// add by turning into each other is left out: a tenth of a millimetre in 50 ms.
  Twist over(double dt) const { return dt * velocity + dt * dt / 2 * acceleration; }
  /// From the body at the moment to the body `dt` (s) later.
  RigidMotion T_later_moment(double dt) const;

  bool operator==(const SweepMotion&) const = default;
};

}  // namespace fovea
