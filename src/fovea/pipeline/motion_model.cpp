#include "fovea/pipeline/motion_model.h"

#include "fovea/base/angle.h"

namespace fovea {
namespace {

/// How far a frame's motion may differ from the last one's: no vehicle accelerates or turns in
/// faster, and registration and GPS are better than the constants.
constexpr double kAcceleration = 10, kShift = 0.2;                  // m/s^2, m
constexpr double kTurnRate = 100 * kDegree, kTurn = 1.5 * kDegree;  // rad/s^2, rad

bool contradict(const MotionGuess& a, const MotionGuess& b, double elapsed) {
  const double shift = kShift + kAcceleration * elapsed * elapsed;
  const double turn = kTurn + kTurnRate * elapsed * elapsed;
  const RigidMotion apart = a.T_odom_lidar.inverse() * b.T_odom_lidar;
  if (apart.translation().norm() > shift || rotation_angle(apart.linear()) > turn) return true;
  if (!a.velocity || !b.velocity) return false;
  const Twist change = (*a.velocity - *b.velocity) * elapsed;
  return change.tail<3>().norm() > shift || change.head<3>().norm() > turn;
}

}  // namespace

std::optional<RigidMotion> MotionModel::navigation_at(TimeNs stamp) const {
  if (navigation_ == nullptr) return std::nullopt;
  return options_.interpolate ? navigation_->at(stamp) : navigation_->nearest(stamp);
}

std::optional<MotionGuess> MotionModel::by_navigation(TimeNs stamp, TimeNs sweep_end) const {
  const auto now = navigation_at(stamp);
  if (!now) return std::nullopt;
  const auto velocity = navigation_->velocity(stamp, sweep_end);
  if (!last_) return MotionGuess{*now, velocity, true};
  const auto then = navigation_at(last_->time);
  if (!then) return std::nullopt;
  return MotionGuess{last_->T_local_body * (then->inverse() * *now), velocity, true};
}

std::optional<MotionGuess> MotionModel::by_velocity(TimeNs stamp) const {
  if (!last_ || !before_last_) return std::nullopt;
  const Twist velocity = log_se3(before_last_->T_local_body.inverse() * last_->T_local_body) /
                         seconds(last_->time - before_last_->time);
  MotionGuess guess{last_->T_local_body * exp_se3(velocity * seconds(stamp - last_->time)),
                    velocity, false};
  // Guesses made of guesses would double their rounding every frame.
  guess.T_odom_lidar.linear() = nearest_rotation(guess.T_odom_lidar.linear());
  return guess;
}

MotionPrediction MotionModel::predict(TimeNs stamp, TimeNs sweep_end) const {
  MotionPrediction prediction;
  prediction.T_local_lidar_navigation = navigation_at(stamp);
  const auto by_nav = by_navigation(stamp, sweep_end);
  const auto by_motion = by_velocity(stamp);
  if (by_nav && by_motion && options_.doubt &&
      contradict(*by_nav, *by_motion, seconds(stamp - last_->time))) {
    prediction.guesses = {*by_motion, *by_nav};
  } else if (by_nav) {
    prediction.guesses = {*by_nav};
  } else if (by_motion) {
    prediction.guesses = {*by_motion};
  } else {
    prediction.guesses = {{last_ ? last_->T_local_body : RigidMotion::Identity(), {}, false}};
  }
  return prediction;
}

void MotionModel::update(TimeNs stamp, const RigidMotion& T_odom_lidar) {
  before_last_ = last_;
  last_ = StampedPose{stamp, T_odom_lidar};
}

}  // namespace fovea
