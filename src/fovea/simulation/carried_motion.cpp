#include "fovea/simulation/carried_motion.h"

#include <cmath>
#include <numbers>

#include "fovea/core/random.h"

namespace fovea {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Displacement (m) and angles (rad) about forward, left and up.
struct Sway {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero(), angles = Eigen::Vector3d::Zero();
};

/// A person takes two steps in each period: the rig rises with each of them, and leans to the side
/// of the foot on the ground. The hands add slow motions.
Sway walking(double time, double phase) {
  constexpr double kStepsPerSecond = 1.9, kHandRate = 0.4;
  const double step = kTurn * kStepsPerSecond * time + phase, stride = step / 2,
               hand = kTurn * kHandRate * time + phase;
  Sway sway;
  sway.shift << 0.015 * std::sin(step), 0.03 * std::sin(stride), 0.025 * std::cos(step);
  sway.angles << 2 * std::sin(stride + 0.4) + 2.5 * std::sin(hand),
      1.5 * std::sin(step + 1) + 2.5 * std::sin(1.3 * hand), 1.5 * std::sin(stride + 0.9);
  sway.angles *= kDegree;
  return sway;
}

/// A drone leans to change its velocity, rises and sinks, and vibrates by a fraction of a
/// millimeter.
Sway flying(double time, double phase) {
  const auto sine = [&](double period, double shift) {
    return std::sin(kTurn * time / period + phase + shift);
  };
  Sway sway;
  sway.shift << 0.1 * sine(3.1, 0), 0.15 * sine(2.3, 1), 0.5 * sine(7.3, 2);
  sway.angles << 8 * sine(2.3, 1.2) + 0.003 * sine(0.033, 0),
      6 * sine(3.1, 0.3) + 0.003 * sine(0.037, 1), 4 * sine(5.7, 2);
  sway.angles *= kDegree;
  return sway;
}

}  // namespace

CarriedMotion::CarriedMotion(const VehicleOptions& options, int seed) : options_(options) {
  constexpr std::uint64_t kKind = 0x63617272696564;
  phase_ = Random::of_item(static_cast<std::uint64_t>(seed), kKind, 0).uniform(0, kTurn);
}

double CarriedMotion::turned(double time) const {
  if (options_.turn_rate == 0) return 0;
  return options_.turn_angle * std::sin(options_.turn_rate / options_.turn_angle * time);
}

double CarriedMotion::climbed(double way) const {
  if (options_.stairs == 0) return 0;
  constexpr double kSteepest = 0.6;  // m a meter: steps 17 cm high and 29 cm deep
  return options_.stairs / 2 * (1 - std::cos(2 * kSteepest / options_.stairs * way));
}

RigidMotion CarriedMotion::T_vehicle_carried(double time, double way) const {
  Sway sway;
  if (options_.carrier == Carrier::kWalker) sway = walking(time, phase_);
  if (options_.carrier == Carrier::kDrone) sway = flying(time, phase_);
  RigidMotion T = RigidMotion::Identity();
  T.translation() = sway.shift + climbed(way) * Eigen::Vector3d::UnitZ();
  T.linear() = (Eigen::AngleAxisd(turned(time) + sway.angles.z(), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(sway.angles.y(), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(sway.angles.x(), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return T;
}

}  // namespace fovea
