#include "fovea/simulation/navigation_errors.h"

#include <cmath>
#include <cstdint>

#include "fovea/core/random.h"

namespace fovea {
namespace {

constexpr double kOutageEvery = 20;  // s
constexpr double kOutageDrift = 10;  // times the walk with satellites
/// Walk of the velocity in an outage: times its noise, per square root of a second.
constexpr double kOutageVelocityWalk = 5;

enum Kind : std::uint64_t { kBias = 0x6e617600, kWhite, kWalk, kDrift, kJump, kOutage, kMotion };

Eigen::Vector3d normal_vector(Random& random, double deviation) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return deviation * Eigen::Vector3d(x, y, z);
}

/// How long the satellites have been lost (s); 0 if they are there.
double time_in_outage(double time, std::uint64_t seed) {
  const double block = std::floor(time / kOutageEvery);
  Random random = Random::of_item(seed, kOutage, static_cast<std::uint64_t>(std::int64_t(block)));
  const double begin = block * kOutageEvery + random.uniform(2, 6);
  const double end = begin + random.uniform(4, 10);
  return time > begin && time < end ? time - begin : 0;
}

}  // namespace

std::vector<NavigationError> navigation_errors(const std::vector<double>& times,
                                               const NavigationOptions& options, int seed) {
  const auto stream = static_cast<std::uint64_t>(seed);
  Random of_bias = Random::of_item(stream, kBias, 0);
  Eigen::Vector3d bias = normal_vector(of_bias, options.position_bias);  // and what jumps add to it
  Eigen::Vector3d position_walk = Eigen::Vector3d::Zero(), angle_walk = position_walk,
                  drift = position_walk, velocity_drift = position_walk;
  std::vector<NavigationError> errors;
  errors.reserve(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double step = i > 0 ? times[i] - times[i - 1] : 0;
    const double lost_for = options.outages ? time_in_outage(times[i], stream) : 0;
    Random of_walk = Random::of_item(stream, kWalk, i),
           of_drift = Random::of_item(stream, kDrift, i),
           of_jump = Random::of_item(stream, kJump, i),
           of_white = Random::of_item(stream, kWhite, i),
           of_motion = Random::of_item(stream, kMotion, i);

    position_walk += normal_vector(of_walk, options.position_walk * std::sqrt(step));
    angle_walk += normal_vector(of_walk, options.angle_walk * std::sqrt(step));
    if (lost_for > 0) {
      drift += normal_vector(of_drift, kOutageDrift * options.position_walk * std::sqrt(step));
      velocity_drift +=
          normal_vector(of_motion, kOutageVelocityWalk * options.velocity_noise * std::sqrt(step));
    } else {
      drift.setZero();
      velocity_drift.setZero();
      if (of_jump.uniform() < -std::expm1(-options.jump_rate * step)) {
        bias += normal_vector(of_jump, options.jump_size);
      }
    }
    NavigationError error;
    error.position = bias + position_walk + drift + normal_vector(of_white, options.position_noise);
    error.angles = angle_walk + normal_vector(of_white, options.angle_noise);
    error.velocity = velocity_drift + normal_vector(of_motion, options.velocity_noise);
    error.rate = normal_vector(of_motion, options.rate_noise);
    error.outage = lost_for > 0;
    error.accuracy =
        std::sqrt(std::pow(options.position_bias, 2) + std::pow(options.position_noise, 2) +
                  std::pow(kOutageDrift * options.position_walk, 2) * lost_for);
    errors.push_back(error);
  }
  return errors;
}

}  // namespace fovea
