#include "fovea/pipeline/motion_guess.h"

#include "fovea/core/angle.h"

namespace fovea {
namespace {

/// Largest difference between the motions of two frames. A vehicle's acceleration and yaw
/// acceleration are lower, and the constant parts exceed the errors of registration and GPS.
constexpr double kAcceleration = 10, kShift = 0.2;                          // m/s^2, m
constexpr double kRotationRate = 100 * kDegree, kRotation = 1.5 * kDegree;  // rad/s^2, rad

}  // namespace

bool contradict(const MotionGuess& a, const MotionGuess& b, double elapsed) {
  const double shift = kShift + kAcceleration * elapsed * elapsed;
  const double turn = kRotation + kRotationRate * elapsed * elapsed;
  const RigidMotion apart = a.T_odom_lidar.inverse() * b.T_odom_lidar;
  if (apart.translation().norm() > shift || rotation_angle(apart.linear()) > turn) return true;
  if (!a.motion || !b.motion) return false;
  const Twist change = (a.motion->velocity - b.motion->velocity) * elapsed;
  return change.tail<3>().norm() > shift || change.head<3>().norm() > turn;
}

}  // namespace fovea
