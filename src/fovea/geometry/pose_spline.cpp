#include "fovea/geometry/pose_spline.h"

#include <algorithm>

namespace fovea {
namespace {

Twist lie_bracket(const Twist& a, const Twist& b) {
  const Eigen::Vector3d w_a = a.head<3>(), v_a = a.tail<3>(), w_b = b.head<3>(), v_b = b.tail<3>();
  return (Twist() << w_a.cross(w_b), w_a.cross(v_b) + v_a.cross(w_b)).finished();
}

/// Velocity, in the body frame, of exp_se3(x) where x changes by `slope` per second. The first
/// terms of the series of the right Jacobian: x is small.
Twist velocity_of(const Twist& x, const Twist& slope) {
  const Twist bracket = lie_bracket(x, slope);
  return slope - bracket / 2 + lie_bracket(x, bracket) / 6;
}

/// The inverse of velocity_of().
Twist slope_of(const Twist& x, const Twist& velocity) {
  const Twist bracket = lie_bracket(x, velocity);
  return velocity + bracket / 2 + lie_bracket(x, bracket) / 12;
}

}  // namespace

PoseSpline::PoseSpline(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  const auto joined = [&](std::size_t i) {
    return i + 1 < poses_.size() && poses_[i + 1].time - poses_[i].time <= kMaxGap;
  };
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const std::size_t first = i > 0 && joined(i - 1) ? i - 1 : i;
    const std::size_t last = joined(i) ? i + 1 : i;
    poses_[i].velocity.reset();
    if (first == last) continue;
    poses_[i].velocity = velocity_between(poses_[first].T_local_body, poses_[last].T_local_body,
                                          seconds(poses_[last].time - poses_[first].time));
  }
}

std::optional<PoseSpline::State> PoseSpline::at(TimeNs time) const {
  const auto next =
      std::upper_bound(poses_.begin(), poses_.end(), time,
                       [](TimeNs t, const StampedPose& pose) { return t < pose.time; });
  const StampedPose* before = next == poses_.begin() ? nullptr : &*(next - 1);
  const StampedPose* after = next == poses_.end() ? nullptr : &*next;
  if (before != nullptr && after != nullptr && after->time - before->time <= kMaxGap) {
    const double step = seconds(after->time - before->time);
    const double s = seconds(time - before->time) / step;
    // x(s): from the pose before, as a twist; x(0) = 0, x(1) = whole.
    const Twist whole = log_se3(before->T_local_body.inverse() * after->T_local_body);
    const Twist begin = step * *before->velocity, end = step * slope_of(whole, *after->velocity);
    const Twist x =
        (3 - 2 * s) * s * s * whole + s * (1 - s) * (1 - s) * begin + s * s * (s - 1) * end;
    const Twist slope =
        6 * s * (1 - s) * whole + (1 - s) * (1 - 3 * s) * begin + s * (3 * s - 2) * end;
    return State{before->T_local_body * exp_se3(x), velocity_of(x, slope / step)};
  }
  for (const StampedPose* pose : {before, after}) {
    if (pose == nullptr || !pose->velocity) continue;
    if (std::abs(time - pose->time) > kMaxExtrapolation) continue;
    return State{pose->T_local_body * exp_se3(seconds(time - pose->time) * *pose->velocity),
                 *pose->velocity};
  }
  return std::nullopt;
}

}  // namespace fovea
