#include "fovea/pipeline/motion_model.h"

namespace fovea {

std::optional<RigidMotion> MotionModel::navigation_at(TimeNs stamp) const {
  if (navigation_ == nullptr) return std::nullopt;
  return interpolate_ ? navigation_->at(stamp) : navigation_->nearest(stamp);
}

MotionPrediction MotionModel::predict(TimeNs stamp, TimeNs sweep_end) const {
  MotionPrediction prediction;
  if (last_) prediction.T_local_lidar = last_->T_local_body;

  const auto now = navigation_at(stamp);
  if (now) {
    prediction.T_local_lidar_navigation = now;
    prediction.velocity = navigation_->velocity(stamp, sweep_end);
    const auto then = last_ ? navigation_at(last_->time) : std::nullopt;
    if (!last_) {
      prediction.T_local_lidar = *now;
    } else if (then) {
      prediction.T_local_lidar = last_->T_local_body * (then->inverse() * *now);
    }
    if (!last_ || then) return prediction;
  }
  if (last_ && before_last_) {
    const Twist velocity = log_se3(before_last_->T_local_body.inverse() * last_->T_local_body) /
                           seconds(last_->time - before_last_->time);
    prediction.T_local_lidar =
        last_->T_local_body * exp_se3(velocity * seconds(stamp - last_->time));
    // Guesses made of guesses would double their rounding every frame.
    prediction.T_local_lidar.linear() = nearest_rotation(prediction.T_local_lidar.linear());
    if (!prediction.velocity) prediction.velocity = velocity;
  }
  return prediction;
}

void MotionModel::update(TimeNs stamp, const RigidMotion& T_local_lidar) {
  before_last_ = last_;
  last_ = StampedPose{stamp, T_local_lidar};
}

}  // namespace fovea
