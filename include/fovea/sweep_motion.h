// How a body moves while a scan is taken, and when its points were measured.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "fovea/rigid_motion.h"

namespace fovea {

/// Where a body was at even steps of time, as measured by an IMU.
struct FOVEA_API SweepPath {
  double begin = 0;               ///< s from the moment to the first place
  double step = 0;                ///< s from place to place
  std::vector<Twist> placements;  ///< rotation vector (rad) and translation (m); two or more

  /// From the body `dt` (s) after the moment to the body at the moment. Beyond the ends the first
  /// or the last step goes on.
  RigidMotion at(double dt) const;

  bool operator==(const SweepPath&) const = default;
};

/// How a body moves about a moment.
struct FOVEA_API SweepMotion {
  Twist velocity = Twist::Zero();                ///< of the body in its own frame, a second
  Twist acceleration = Twist::Zero();            ///< the velocity's change, a second squared
  std::optional<SweepPath> path = std::nullopt;  ///< absent: the two above tell the motion

  /// Twist from where it is at the moment to where it is `dt` (s) later, or earlier. What the two
  /// add by turning into each other is left out: a tenth of a millimeter in 50 ms.
  Twist over(double dt) const { return dt * velocity + dt * dt / 2 * acceleration; }
  /// From the body at the moment to the body `dt` (s) later.
  RigidMotion T_later_moment(double dt) const;

  bool operator==(const SweepMotion&) const = default;
};

/// Direction of rotation, seen from above.
enum class SweepDirection { kClockwise, kCounterclockwise };

/// When the points of a sweep were measured, for scans whose points have no times.
///
/// The sensor turns once a period. It starts at `start_azimuth`; at the scan's stamp it has
/// completed the share `stamp_phase` of the sweep. The defaults are KITTI's: clockwise from behind,
/// so that the sensor faces forward at the stamp.
struct SweepTiming {
  double period = 0.1;  ///< s
  SweepDirection direction = SweepDirection::kClockwise;
  double start_azimuth = std::numbers::pi;  ///< rad, atan2(y, x) in the LiDAR frame
  double stamp_phase = 0.5;                 ///< 0: stamped at the start of the sweep; 1: at its end

  /// From the stamp to the start, the middle and the end of the sweep (s).
  double start_time() const { return -stamp_phase * period; }
  double middle_time() const { return (0.5 - stamp_phase) * period; }
  double end_time() const { return (1 - stamp_phase) * period; }

  bool operator==(const SweepTiming&) const = default;
};

}  // namespace fovea
