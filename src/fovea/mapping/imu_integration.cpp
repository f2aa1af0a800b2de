#include "fovea/mapping/imu_integration.h"

#include <algorithm>
#include <cmath>

#include "fovea/geometry/imu_gap.h"
#include "fovea/geometry/rotation_vector.h"

namespace fovea {
namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Covariance = InertialState::Covariance;
using State = InertialState;

// Deviations of velocities in a gap of the IMU, per root second: rad/s and m/s.
constexpr double kGapRate = 0.5, kGapForce = 2;

/// Walk of the direction of gravity in odom, whose poses tilt with the way: rad per root second.
constexpr double kLevelWalk = 1e-4;

}  // namespace

Eigen::Matrix<double, 3, 2> across_gravity(const InertialState& state) {
  const Vector3 down = state.gravity.normalized();
  constexpr double kSteep = 0.9;  // component of gravity: the axis gives no direction across it
  const Vector3 axis = std::abs(down.x()) > kSteep ? Vector3::UnitY() : Vector3::UnitX();
  const Vector3 first = axis.cross(down).normalized();
  Eigen::Matrix<double, 3, 2> axes;
  axes << first, down.cross(first);
  return axes;
}

ImuIntegration::ImuIntegration(const ImuData& imu)
    : imu_(&imu), gap_limit_(imu_gap_limit(imu.samples)) {}

bool ImuIntegration::covers(TimeNs stamp) const {
  constexpr TimeNs kLongest = kNsPerSecond / 2;
  const auto later = [](TimeNs time, const ImuSample& sample) { return time < sample.time; };
  const auto after = std::upper_bound(imu_->samples.begin(), imu_->samples.end(), stamp, later);
  return after != imu_->samples.begin() && stamp - std::prev(after)->time <= kLongest;
}

ImuIntegration::Measured ImuIntegration::measured(TimeNs from, TimeNs to) const {
  const TimeNs middle = from + (to - from) / 2;
  const auto later = [](TimeNs time, const ImuSample& sample) { return time < sample.time; };
  const auto after = std::upper_bound(imu_->samples.begin(), imu_->samples.end(), middle, later);
  const bool is_outside = after == imu_->samples.begin() || after == imu_->samples.end();
  const ImuSample& a = after == imu_->samples.begin() ? *after : *std::prev(after);
  if (is_outside || after->time - a.time > gap_limit_) return {a.rate, a.force, true};
  const ImuSample& b = *after;
  const double share = seconds(middle - a.time) / seconds(b.time - a.time);
  return {a.rate + share * (b.rate - a.rate), a.force + share * (b.force - a.force), false};
}

void ImuIntegration::step(InertialState& state, TimeNs time, bool with_covariance) const {
  const double dt = seconds(time - state.time);
  const Measured measured = this->measured(state.time, time);
  const Vector3 rate = measured.rate - state.rate_bias, force = measured.force - state.force_bias;
  const Matrix3 R = state.T_odom_imu.linear();
  const Matrix3 R_middle = R * rotation_of(rate * dt / 2);
  // In a gap both velocities stay as they are.
  const Vector3 acceleration =
      measured.is_gap ? Vector3::Zero() : Vector3(R_middle * force + state.gravity);

  if (with_covariance) {
    // Derivatives of the errors (Sola 2017, 5.4), to first order in dt.
    Covariance F = Covariance::Identity();
    F.block<3, 3>(State::kRotation, State::kRotation) = rotation_of(-rate * dt);
    F.block<3, 3>(State::kRotation, State::kRateBias) = -dt * Matrix3::Identity();
    F.block<3, 3>(State::kPosition, State::kVelocity) = dt * Matrix3::Identity();
    if (!measured.is_gap) {
      auto velocity = F.middleRows<3>(State::kVelocity);
      velocity.middleCols<3>(State::kRotation) = -dt * R_middle * hat(force);
      velocity.middleCols<3>(State::kForceBias) = -dt * R_middle;
      velocity.middleCols<2>(State::kGravityAngles) =
          -dt * hat(state.gravity) * across_gravity(state);
      for (const auto& [place, size] :
           {std::pair(State::kRotation, 3), {State::kForceBias, 3}, {State::kGravityAngles, 2}}) {
        F.block(State::kPosition, place, 3, size) = dt / 2 * velocity.middleCols(place, size);
      }
    }
    state.covariance = F * state.covariance * F.transpose();
    const ImuNoise& noise = imu_->noise;
    const auto add_noise = [&](int place, double density) {
      state.covariance.diagonal().segment<3>(place).array() += density * density * dt;
    };
    add_noise(State::kRotation, measured.is_gap ? kGapRate : noise.gyroscope_noise_density);
    add_noise(State::kVelocity, measured.is_gap ? kGapForce : noise.accelerometer_noise_density);
    add_noise(State::kRateBias, noise.gyroscope_random_walk);
    add_noise(State::kForceBias, noise.accelerometer_random_walk);
    state.covariance.diagonal().tail<2>().array() += kLevelWalk * kLevelWalk * dt;
  }

  state.T_odom_imu.linear() = R * rotation_of(rate * dt);
  state.T_odom_imu.translation() += dt * state.velocity + dt * dt / 2 * acceleration;
  state.velocity += dt * acceleration;
  state.time = time;
}

void ImuIntegration::move(InertialState& state, TimeNs time, bool with_covariance) const {
  const auto earlier = [](const ImuSample& sample, TimeNs at) { return sample.time < at; };
  const auto later = [](TimeNs at, const ImuSample& sample) { return at < sample.time; };
  while (state.time < time) {
    const auto next =
        std::upper_bound(imu_->samples.begin(), imu_->samples.end(), state.time, later);
    const TimeNs until = next == imu_->samples.end() ? time : std::min(time, next->time);
    step(state, until, with_covariance);
  }
  while (state.time > time) {
    const auto next =
        std::lower_bound(imu_->samples.begin(), imu_->samples.end(), state.time, earlier);
    const TimeNs until =
        next == imu_->samples.begin() ? time : std::max(time, std::prev(next)->time);
    step(state, until, with_covariance);
  }
  state.T_odom_imu.linear() = nearest_rotation(state.T_odom_imu.linear());
}

}  // namespace fovea
