#include "fovea/trajectory.h"

#include <algorithm>
#include <stdexcept>

#include "fovea/core/angle.h"

namespace fovea {
namespace {

/// No vehicle's velocity changes faster; a hand-held rig's may, and is then taken as steady.
constexpr double kMaxAcceleration = 20;                 // m/s^2
constexpr double kMaxTurnAcceleration = 200 * kDegree;  // rad/s^2

/// Half a sweep of a LiDAR at 20 Hz: velocities need such a span, even where the sweep ends at its
/// stamp.
constexpr TimeNs kLeastReach = kNsPerSecond / 40;

/// Whether two consecutive poses have no outage between them.
bool are_joined(const StampedPose& a, const StampedPose& b) {
  return b.time - a.time <= Trajectory::kMaxGap;
}

/// The pose at a time, by the constant twist from `a` to `b`.
RigidMotion on_line(const StampedPose& a, const StampedPose& b, TimeNs time) {
  return interpolate(a.T_local_body, b.T_local_body,
                     seconds(time - a.time) / seconds(b.time - a.time));
}

/// The span of measurements and poses that give the motion at `time`.
TimeNs reach_of(TimeNs time, TimeNs known_until) {
  return std::max(known_until - time, kLeastReach);
}

}  // namespace

Trajectory::Trajectory(std::vector<StampedPose> poses) {
  if (poses.empty()) throw std::invalid_argument("a trajectory needs at least one pose");
  extend(poses);
}

void Trajectory::extend(const std::vector<StampedPose>& poses) {
  poses_.reserve(poses_.size() + poses.size());
  for (const StampedPose& pose : poses) append(pose);
}

void Trajectory::append(const StampedPose& pose) {
  if (!poses_.empty() && pose.time <= poses_.back().time) {
    throw std::invalid_argument("the times of a trajectory must increase");
  }
  const bool is_frozen = !poses_.empty() && pose.T_local_body.translation() ==
                                                poses_.back().T_local_body.translation();
  poses_.push_back(pose);
  if (is_frozen) poses_.back().velocity.reset();
}

std::size_t Trajectory::drop_before(TimeNs time) {
  if (poses_.empty()) return 0;
  const auto kept = std::find_if(poses_.begin(), std::prev(poses_.end()),
                                 [&](const StampedPose& pose) { return pose.time >= time; });
  const auto dropped = std::size_t(kept - poses_.begin());
  poses_.erase(poses_.begin(), kept);
  return dropped;
}

std::optional<RigidMotion> Trajectory::at(TimeNs time) const {
  const auto next = std::upper_bound(poses_.begin(), poses_.end(), time,
                                     [](TimeNs t, const StampedPose& p) { return t < p.time; });
  const bool has_before = next != poses_.begin(), has_next = next != poses_.end();
  if (has_before && has_next && are_joined(*(next - 1), *next)) {
    return on_line(*(next - 1), *next, time);
  }
  // Before the first pose, after the last one, or in an outage.
  const TimeNs since_last = has_before ? time - (next - 1)->time : kMaxExtrapolation + 1;
  const TimeNs until_next = has_next ? next->time - time : kMaxExtrapolation + 1;
  if (std::min(since_last, until_next) > kMaxExtrapolation) return std::nullopt;
  const auto nearest = since_last <= until_next ? next - 1 : next;
  if (nearest != poses_.begin() && are_joined(*(nearest - 1), *nearest)) {
    return on_line(*(nearest - 1), *nearest, time);
  }
  if (nearest + 1 != poses_.end() && are_joined(*nearest, *(nearest + 1))) {
    return on_line(*nearest, *(nearest + 1), time);
  }
  if (nearest->velocity) {
    return nearest->T_local_body * exp_se3(*nearest->velocity * seconds(time - nearest->time));
  }
  const bool holds = time == nearest->time || poses_.size() == 1;
  return holds ? std::optional(nearest->T_local_body) : std::nullopt;
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
  auto last = unknown - 1;
  const bool ends_outage = !are_joined(*(last - 1), *last);
  if (ends_outage && unknown != poses_.end()) last = unknown;
  auto first = last - 1;
  while (first != poses_.begin() && last->time - first->time < reach * 3 / 2 &&
         are_joined(*(first - 1), *first)) {
    --first;
  }
  const StampedPose &p0 = *first, &p1 = *last;
  if (!are_joined(p0, p1) || time < p0.time - kMaxGap || time > p1.time + kMaxGap) {
    return std::nullopt;
  }
  return SweepMotion{
      velocity_between(p0.T_local_body, p1.T_local_body, seconds(p1.time - p0.time))};
}

}  // namespace fovea
