#include "fovea/geometry/trajectory.h"

#include <algorithm>
#include <stdexcept>

#include "fovea/base/angle.h"

namespace fovea {
namespace {

/// No vehicle's velocity changes faster; a hand-held rig's may, and is then taken as steady.
constexpr double kMaxAcceleration = 20;                 // m/s^2
constexpr double kMaxTurnAcceleration = 200 * kDegree;  // rad/s^2

/// Half a sweep of a LiDAR at 20 Hz: velocities need such a span, even where the sweep ends at its
/// stamp.
constexpr TimeNs kLeastReach = kNsPerSecond / 40;

/// The span of measurements and poses that give the motion at `time`.
TimeNs reach_of(TimeNs time, TimeNs known_until) {
  return std::max(known_until - time, kLeastReach);
}

}  // namespace

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  if (poses_.empty()) throw std::invalid_argument("a trajectory needs at least one pose");
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    if (poses_[i].time <= poses_[i - 1].time) {
      throw std::invalid_argument("the times of a trajectory must increase");
    }
    if (poses_[i].T_local_body.translation() == poses_[i - 1].T_local_body.translation()) {
      poses_[i].velocity.reset();
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

std::optional<Trajectory::MeanVelocity> Trajectory::mean_velocity(TimeNs begin, TimeNs end,
                                                                  TimeNs about) const {
  auto pose = std::lower_bound(poses_.begin(), poses_.end(), begin,
                               [](const StampedPose& p, TimeNs t) { return p.time < t; });
  MeanVelocity mean{Twist::Zero(), 0};
  int count = 0;
  for (; pose != poses_.end() && pose->time < end; ++pose) {
    if (!pose->velocity) continue;
    mean.velocity += *pose->velocity;
    mean.time += seconds(pose->time - about);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return MeanVelocity{mean.velocity / count, mean.time / count};
}

std::optional<SweepMotion> Trajectory::measured_motion(TimeNs time, TimeNs known_until) const {
  const TimeNs reach = reach_of(time, known_until);
  const auto now = mean_velocity(time - reach, known_until + 1, time);
  if (!now) return std::nullopt;
  const auto before = mean_velocity(time - 3 * reach, time - reach, time);
  // Of velocities a moment apart the change would be their noise.
  if (!before || now->time - before->time < seconds(reach)) return SweepMotion{now->velocity};
  const Twist change = (now->velocity - before->velocity) / (now->time - before->time);
  if (change.head<3>().norm() > kMaxTurnAcceleration || change.tail<3>().norm() > kMaxAcceleration)
    return SweepMotion{now->velocity};
  return SweepMotion{now->velocity - now->time * change, change};
}

std::optional<SweepMotion> Trajectory::motion(TimeNs time, TimeNs known_until) const {
  const TimeNs reach = reach_of(time, known_until);
  if (auto measured = measured_motion(time, known_until)) return measured;
  if (poses_.size() < 2) return std::nullopt;
  const auto unknown = std::upper_bound(poses_.begin() + 2, poses_.end(), known_until,
                                        [](TimeNs t, const StampedPose& p) { return t < p.time; });
  const auto last = unknown - 1;
  auto first = last - 1;
  while (first != poses_.begin() && last->time - first->time < reach * 3 / 2) --first;
  const StampedPose &p0 = *first, &p1 = *last;
  if (p1.time - p0.time > kMaxGap) return std::nullopt;
  return SweepMotion{
      velocity_between(p0.T_local_body, p1.T_local_body, seconds(p1.time - p0.time))};
}

}  // namespace fovea
