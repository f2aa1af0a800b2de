#include "fovea/simulation/vehicle_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fovea/core/random.h"

namespace fovea {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// A sum of two sines with amplitudes that add up to 1.
struct Wave {
  double amplitude[2];
  double period[2];

  double value(double x, const double* phases) const {
    double sum = 0;
    for (int i = 0; i < 2; ++i) {
      sum += amplitude[i] * std::sin(kTurn * x / period[i] + phases[i]);
    }
    return sum;
  }
  double slope(double x, const double* phases) const {
    double sum = 0;
    for (int i = 0; i < 2; ++i) {
      const double rate = kTurn / period[i];
      sum += amplitude[i] * rate * std::cos(rate * x + phases[i]);
    }
    return sum;
  }
  /// Integral of the value from 0 to x.
  double integral(double x, const double* phases) const {
    double sum = 0;
    for (int i = 0; i < 2; ++i) {
      const double rate = kTurn / period[i];
      sum += amplitude[i] / rate * (std::cos(phases[i]) - std::cos(rate * x + phases[i]));
    }
    return sum;
  }
  /// No integral is larger.
  double largest_integral() const {
    double sum = 0;
    for (int i = 0; i < 2; ++i) sum += 2 * amplitude[i] * period[i] / kTurn;
    return sum;
  }
};

// Periods that have no common multiple within a drive; in seconds, the weave's in metres of way: a
// vehicle that stands still does not slide sideways.
constexpr Wave kSpeed{{0.6, 0.4}, {17.3, 7.4}};
constexpr Wave kWeave{{0.7, 0.3}, {113, 47}};
constexpr Wave kRoll{{0.65, 0.35}, {3.1, 1.7}};
constexpr Wave kPitch{{0.65, 0.35}, {2.7, 1.5}};
constexpr Wave kHeave{{0.6, 0.4}, {2.3, 1.3}};

/// The time that a vehicle which never stops needs for the same way: its clock slows down evenly
/// until it stands, and speeds up again as evenly.
double moving_time(const VehicleOptions& options, double time) {
  const double braking = options.stop_braking, begin = options.stop_at;
  if (begin < 0 || time <= begin) return time;
  const double slowing = std::min(time - begin, braking);
  const double starting = std::clamp(time - begin - braking - options.stop_duration, 0.0, braking);
  const double after = std::max(0.0, time - begin - 2 * braking - options.stop_duration);
  return begin + slowing - slowing * slowing / (2 * braking) + starting * starting / (2 * braking) +
         after;
}

enum Phase { kOfSpeed = 0, kOfWeave = 2, kOfRoll = 4, kOfPitch = 6, kOfHeave = 8 };

}  // namespace

VehicleMotion::VehicleMotion(const Path& path, double lane_offset, const VehicleOptions& options,
                             int seed)
    : path_(&path), lane_offset_(lane_offset), options_(options), carried_(options, seed) {
  constexpr std::uint64_t kKind = 0x6d6f74696f6e;
  Random random = Random::of_item(static_cast<std::uint64_t>(seed), kKind, 0);
  for (double& phase : phases_) phase = random.uniform(0, kTurn);
}

double VehicleMotion::way(double time) const {
  time = moving_time(options_, time);
  return options_.speed *
         (time + options_.speed_variation * kSpeed.integral(time, &phases_[kOfSpeed]));
}

RigidMotion VehicleMotion::T_world_vehicle(double time) const {
  const double s = way(time);
  const Path::Point point = path_->at(s);
  const double aside = lane_offset_ + options_.weave * kWeave.value(s, &phases_[kOfWeave]);
  const double aside_slope = options_.weave * kWeave.slope(s, &phases_[kOfWeave]);
  // d/ds of position + aside * left, in the path's own directions.
  const double yaw = point.heading + std::atan2(aside_slope, 1 - point.curvature * aside);
  const double pitch = options_.sway * kPitch.value(time, &phases_[kOfPitch]);
  const double roll = options_.sway * kRoll.value(time, &phases_[kOfRoll]);

  const Eigen::Vector2d left(-std::sin(point.heading), std::cos(point.heading));
  RigidMotion T = RigidMotion::Identity();
  T.translation() << point.position + aside * left,
      options_.heave * kHeave.value(time, &phases_[kOfHeave]);
  T.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return T * carried_.T_vehicle_carried(time, s);
}

double longest_way(const VehicleOptions& options, double seconds) {
  return options.speed *
         (seconds + options.speed_variation * std::min(seconds, kSpeed.largest_integral()));
}

}  // namespace fovea
