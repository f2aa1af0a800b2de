#include "fovea/geometry/trajectory.h"

#include <algorithm>
#include <stdexcept>

namespace fovea {

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  if (poses_.empty()) throw std::invalid_argument("a trajectory needs at least one pose");
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    if (poses_[i].time <= poses_[i - 1].time) {
      throw std::invalid_argument("the times of a trajectory must increase");
    }
  }
}

std::optional<RigidMotion> Trajectory::at(TimeNs time) const {
  if (poses_.empty() || time < poses_.front().time - kMaxExtrapolation ||
      time > poses_.back().time + kMaxExtrapolation) {
    return std::nullopt;
  }
  if (poses_.size() == 1) return poses_.front().T_local_body;
  const auto after = std::upper_bound(poses_.begin() + 1, poses_.end() - 1, time,
                                      [](TimeNs t, const StampedPose& p) { return t < p.time; });
  const StampedPose &p0 = *(after - 1), &p1 = *after;
  if (p1.time - p0.time > kMaxGap) {
    if (time == p0.time) return p0.T_local_body;
    return time == p1.time ? std::optional(p1.T_local_body) : std::nullopt;
  }
  return interpolate(p0.T_local_body, p1.T_local_body,
                     seconds(time - p0.time) / seconds(p1.time - p0.time));
}

std::optional<RigidMotion> Trajectory::nearest(TimeNs time) const {
  if (!at(time)) return std::nullopt;
  const auto distance = [&](const StampedPose& p) { return std::abs(p.time - time); };
  return std::min_element(
             poses_.begin(), poses_.end(),
             [&](const StampedPose& a, const StampedPose& b) { return distance(a) < distance(b); })
      ->T_local_body;
}

std::optional<Twist> Trajectory::velocity(TimeNs time, TimeNs known_until) const {
  if (poses_.size() < 2) return std::nullopt;
  // The latest pair of neighbours that is known and does not lie wholly after `time`.
  const TimeNs latest = std::max(time, poses_[1].time);
  std::size_t last = 1;
  while (last + 1 < poses_.size() && poses_[last + 1].time <= known_until &&
         poses_[last].time < latest) {
    ++last;
  }
  const StampedPose &p0 = poses_[last - 1], &p1 = poses_[last];
  if (p1.time - p0.time > kMaxGap) return std::nullopt;
  return Twist(log_se3(p0.T_local_body.inverse() * p1.T_local_body) / seconds(p1.time - p0.time));
}

}  // namespace fovea
