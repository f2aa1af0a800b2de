// A guess of how the LiDAR has moved since the last frame.
#pragma once

#include <optional>

#include "fovea/sweep_motion.h"

namespace fovea {

struct MotionGuess {
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  /// Of the LiDAR during the sweep, if known.
  std::optional<SweepMotion> motion;
  bool by_navigation = false;
  /// Standard deviations of the pose (rad, m), if known.
  std::optional<Twist> sigma;
};

/// Whether two guesses differ by more than a vehicle's acceleration and the errors of registration
/// and GPS explain.
/// @param elapsed  s since the last frame
bool contradict(const MotionGuess& a, const MotionGuess& b, double elapsed);

}  // namespace fovea
