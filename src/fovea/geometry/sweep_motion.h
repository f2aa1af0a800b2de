// How a body moves while a scan is taken: not quite steadily.
#pragma once

#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Twists of a body in its own frame, at a moment.
struct SweepMotion {
  Twist velocity = Twist::Zero();      ///< a second
  Twist acceleration = Twist::Zero();  ///< the velocity's change, a second squared

  /// Twist from where it is at the moment to where it is `dt` (s) later, or earlier. What the two
  /// add by turning into each other is left out: a tenth of a millimetre in 50 ms.
  Twist over(double dt) const { return dt * velocity + dt * dt / 2 * acceleration; }

  bool operator==(const SweepMotion&) const = default;
};

}  // namespace fovea
