#include "fovea/mapping/inertial_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "fovea/geometry/rotation_vector.h"

namespace fovea {
namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Covariance = InertialState::Covariance;
using State = InertialState;
using Error = Eigen::Matrix<double, State::kSize, 1>;

constexpr double kGravity = 9.81;  // m/s^2

// Standard deviations at the start.
constexpr double kStartRotation = 1e-4, kStartPosition = 1e-3;                       // rad, m
constexpr double kStillVelocity = 0.02, kKnownVelocity = 0.3, kUnknownVelocity = 3;  // m/s
constexpr double kStillRateBias = 1e-3, kRateBiasSigma = 0.01;                       // rad/s
constexpr double kForceBiasSigma = 0.2;                                              // m/s^2
constexpr double kLevelGravity = 0.02, kStillGravity = 0.03, kMovingGravity = 0.1;   // rad

/// The IMU is at rest if its measurements scatter by less, rad/s and m/s^2.
constexpr double kStillRate = 0.015, kStillForce = 0.15;
/// ... and if the mean rate can be a bias, rad/s.
constexpr double kLargestRateBias = 0.05;

/// m/s, of a LiDAR at rest as registration has it.
constexpr double kStillSpeed = 0.05;

// The start looks at the measurements of this time (s).
constexpr double kStartBefore = 1, kStartAfter = 0.5;

constexpr double kPathStep = 0.005;  // s

/// Of the two rotation vectors of a rotation, the one nearer to another vector.
Vector3 nearest_vector(const Vector3& turn, const Vector3& other) {
  const double angle = turn.norm();
  if (angle == 0) return turn;
  const Vector3 around = turn * (1 - 2 * std::numbers::pi / angle);
  return (around - other).norm() < (turn - other).norm() ? around : turn;
}

void add(const Error& error, InertialState& state) {
  state.T_odom_imu.linear() =
      nearest_rotation(state.T_odom_imu.linear() * rotation_of(error.segment<3>(State::kRotation)));
  state.T_odom_imu.translation() += error.segment<3>(State::kPosition);
  state.velocity += error.segment<3>(State::kVelocity);
  state.rate_bias += error.segment<3>(State::kRateBias);
  state.force_bias += error.segment<3>(State::kForceBias);
  const Vector3 turn = across_gravity(state) * error.segment<2>(State::kGravityAngles);
  state.gravity = rotation_of(turn) * state.gravity;
}

/// Kalman's update for a measurement whose value differs by `difference` from the state's.
template <int N>
void correct(const Eigen::Matrix<double, N, 1>& difference,
             const Eigen::Matrix<double, N, State::kSize>& jacobian,
             const Eigen::Matrix<double, N, 1>& sigma, InertialState& state) {
  const Eigen::Matrix<double, State::kSize, N> PHt = state.covariance * jacobian.transpose();
  Eigen::Matrix<double, N, N> S = jacobian * PHt;
  S.diagonal() += sigma.cwiseAbs2();
  const Eigen::Matrix<double, State::kSize, N> gain = S.ldlt().solve(PHt.transpose()).transpose();
  // Joseph's form stays symmetric and positive.
  const Covariance rest = Covariance::Identity() - gain * jacobian;
  state.covariance = rest * state.covariance * rest.transpose() +
                     gain * sigma.cwiseAbs2().asDiagonal() * gain.transpose();
  add(gain * difference, state);
}

void set_sigma(int place, int size, double sigma, InertialState& state) {
  state.covariance.diagonal().segment(place, size).setConstant(sigma * sigma);
}

struct Scatter {
  Vector3 mean = Vector3::Zero();
  double deviation = 0;  // the largest of the three axes
};

Scatter scatter_of(const std::vector<Vector3>& values) {
  Scatter scatter;
  for (const Vector3& value : values) scatter.mean += value / double(values.size());
  Vector3 squares = Vector3::Zero();
  for (const Vector3& value : values) {
    squares += (value - scatter.mean).cwiseAbs2() / double(values.size());
  }
  scatter.deviation = std::sqrt(squares.maxCoeff());
  return scatter;
}

}  // namespace

InertialFilter::InertialFilter(const ImuData& imu)
    : imu_(&imu), integration_(imu), T_imu_lidar_(imu.T_lidar_imu.inverse()) {}

void InertialFilter::begin(TimeNs stamp, const InertialStart& start) {
  InertialState state;
  state.time = stamp;
  state.T_odom_imu = start.T_odom_lidar * T_imu_lidar_.inverse();

  std::vector<Vector3> rates, forces;
  Vector3 up_odom = Vector3::Zero();
  const auto take = [&](const ImuSample& sample, InertialState& turning) {
    integration_.move(turning, sample.time, /*with_covariance=*/false);
    rates.push_back(sample.rate);
    forces.push_back(sample.force);
    up_odom += turning.T_odom_imu.linear() * sample.force;
  };
  const auto earlier = [](const ImuSample& sample, TimeNs time) { return sample.time < time; };
  const auto middle = std::lower_bound(imu_->samples.begin(), imu_->samples.end(), stamp, earlier);
  InertialState after = state, before = state;  // whose rotations follow the gyroscope
  for (auto next = middle;
       next != imu_->samples.end() && next->time <= stamp + from_seconds(kStartAfter); ++next) {
    take(*next, after);
  }
  for (auto next = middle;
       next != imu_->samples.begin() && std::prev(next)->time >= stamp - from_seconds(kStartBefore);
       --next) {
    take(*std::prev(next), before);
  }
  const Scatter rate = scatter_of(rates), force = scatter_of(forces);
  const bool is_still = !rates.empty() && rate.deviation < kStillRate &&
                        force.deviation < kStillForce && rate.mean.norm() < kLargestRateBias &&
                        start.velocity && start.velocity->tail<3>().norm() < kStillSpeed;
  if (is_still) state.rate_bias = rate.mean;
  if (start.velocity) {
    const Twist of_imu = twist_of_part(*start.velocity, T_imu_lidar_.inverse());
    state.velocity = state.T_odom_imu.linear() * of_imu.tail<3>();
  }
  if (start.is_level || up_odom.isZero(0)) up_odom = Vector3::UnitZ();
  state.gravity = -kGravity * up_odom.normalized();

  set_sigma(State::kRotation, 3, kStartRotation, state);
  set_sigma(State::kPosition, 3, kStartPosition, state);
  const double moving = start.velocity ? kKnownVelocity : kUnknownVelocity;
  set_sigma(State::kVelocity, 3, is_still ? kStillVelocity : moving, state);
  set_sigma(State::kRateBias, 3, is_still ? kStillRateBias : kRateBiasSigma, state);
  set_sigma(State::kForceBias, 3, kForceBiasSigma, state);
  const double tilted = is_still ? kStillGravity : kMovingGravity;
  set_sigma(State::kGravityAngles, 2, start.is_level ? kLevelGravity : tilted, state);
  state_ = state;
}

/// Of a twist of the LiDAR about its own origin.
InertialFilter::PoseJacobian InertialFilter::pose_jacobian(const InertialState& state) const {
  const Matrix3 R_lidar_imu = T_imu_lidar_.linear().transpose();
  const Matrix3 R_lidar_odom = R_lidar_imu * state.T_odom_imu.linear().transpose();
  PoseJacobian jacobian = PoseJacobian::Zero();
  jacobian.block<3, 3>(0, State::kRotation) = R_lidar_imu;
  jacobian.block<3, 3>(3, State::kRotation) = -R_lidar_imu * hat(T_imu_lidar_.translation());
  jacobian.block<3, 3>(3, State::kPosition) = R_lidar_odom;
  return jacobian;
}

Twist InertialFilter::pose_sigma(const InertialState& state) const {
  const PoseJacobian J = pose_jacobian(state);
  return (J * state.covariance * J.transpose()).diagonal().cwiseSqrt();
}

Twist InertialFilter::velocity_of(const InertialState& state) const {
  const Vector3 rate = integration_.rate(state);
  Twist of_imu;
  of_imu << rate, state.T_odom_imu.linear().transpose() * state.velocity;
  return twist_of_part(of_imu, T_imu_lidar_);
}

SweepMotion InertialFilter::motion(const InertialPrediction& prediction,
                                   const SweepSpan& sweep) const {
  const InertialState& at_stamp = prediction.state;
  const double begin = std::min(sweep.begin, -kPathStep), end = std::max(sweep.end, kPathStep);
  const auto steps = static_cast<int>(std::ceil((end - begin) / kPathStep));
  const RigidMotion T_lidar_odom = T_odom_lidar(at_stamp).inverse();
  SweepPath path{begin, kPathStep, {}};
  InertialState moving = at_stamp;
  integration_.move(moving, at_stamp.time + from_seconds(begin), /*with_covariance=*/false);
  for (int i = 0; i <= steps; ++i) {
    integration_.move(moving, at_stamp.time + from_seconds(begin + i * kPathStep),
                      /*with_covariance=*/false);
    const RigidMotion T = T_lidar_odom * T_odom_lidar(moving);
    const Vector3 turn = rotation_vector(T.linear());
    const Vector3 last = path.placements.empty() ? turn : Vector3(path.placements.back().head<3>());
    path.placements.emplace_back() << nearest_vector(turn, last), T.translation();
  }
  return {velocity_of(at_stamp), Twist::Zero(), std::move(path)};
}

InertialPrediction InertialFilter::predict(TimeNs stamp) const {
  if (!state_) throw std::logic_error("the filter has not begun");
  InertialPrediction prediction{.state = *state_};
  integration_.move(prediction.state, stamp, /*with_covariance=*/true);
  prediction.T_odom_lidar = T_odom_lidar(prediction.state);
  prediction.sigma = pose_sigma(prediction.state);
  return prediction;
}

InertialPrediction InertialFilter::corrected(const InertialPrediction& prediction,
                                             const RigidMotion& T_odom_lidar,
                                             const Twist& sigma) const {
  InertialPrediction result = prediction;
  const Twist difference = log_se3(prediction.T_odom_lidar.inverse() * T_odom_lidar);
  correct<6>(difference, pose_jacobian(result.state), sigma, result.state);
  result.T_odom_lidar = this->T_odom_lidar(result.state);
  result.sigma = pose_sigma(result.state);
  return result;
}

InertialPrediction InertialFilter::corrected(const InertialPrediction& prediction, double speed,
                                             double sigma, const RigidMotion& T_lidar_body) const {
  InertialPrediction result = prediction;
  const InertialState& state = prediction.state;
  const RigidMotion T_imu_body = T_imu_lidar_ * T_lidar_body;
  const Vector3 forward = T_imu_body.linear().col(0);  // of the body, in the axes of the IMU
  const Vector3 rate = integration_.rate(state);
  const Vector3 velocity_imu = state.T_odom_imu.linear().transpose() * state.velocity;
  const double expected = forward.dot(velocity_imu + rate.cross(T_imu_body.translation()));
  Eigen::Matrix<double, 1, State::kSize> jacobian = Eigen::Matrix<double, 1, State::kSize>::Zero();
  jacobian.segment<3>(State::kRotation) = forward.transpose() * hat(velocity_imu);
  jacobian.segment<3>(State::kVelocity) =
      forward.transpose() * state.T_odom_imu.linear().transpose();
  jacobian.segment<3>(State::kRateBias) = forward.transpose() * hat(T_imu_body.translation());
  constexpr double kSigmas = 5;  // beyond: the wheels slip, or the speed has another sign or unit
  const double variance = (jacobian * state.covariance * jacobian.transpose())(0) + sigma * sigma;
  if (std::abs(speed - expected) > kSigmas * std::sqrt(variance)) return prediction;
  correct<1>(Eigen::Matrix<double, 1, 1>(speed - expected), jacobian,
             Eigen::Matrix<double, 1, 1>(sigma), result.state);
  result.T_odom_lidar = T_odom_lidar(result.state);
  result.sigma = pose_sigma(result.state);
  return result;
}

void InertialFilter::update(const InertialPrediction& prediction, const RigidMotion& T_odom_lidar,
                            const std::optional<Twist>& sigma) {
  state_ = sigma ? corrected(prediction, T_odom_lidar, *sigma).state : prediction.state;
}

void InertialFilter::place(const InertialPrediction& prediction, const RigidMotion& T_odom_lidar) {
  InertialState state = prediction.state;
  if (!state.covariance.allFinite() || !state.velocity.allFinite()) return restart();
  // The velocity turns with the IMU.
  const RigidMotion T_odom_imu = T_odom_lidar * T_imu_lidar_.inverse();
  state.velocity = T_odom_imu.linear() * (state.T_odom_imu.linear().transpose() * state.velocity);
  state.T_odom_imu = T_odom_imu;
  constexpr int kPose = State::kVelocity;  // the size of rotation and position
  state.covariance.topRows<kPose>().setZero();
  state.covariance.leftCols<kPose>().setZero();
  set_sigma(State::kRotation, 3, kStartRotation, state);
  set_sigma(State::kPosition, 3, kStartPosition, state);
  state_ = state;
}

}  // namespace fovea
