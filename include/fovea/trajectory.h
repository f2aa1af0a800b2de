// Time-stamped poses of one body, interpolated on SE(3).
#pragma once

#include <optional>
#include <vector>

#include "fovea/sweep_motion.h"
#include "fovea/time.h"

namespace fovea {

struct StampedPose {
  TimeNs time = 0;
  RigidMotion T_local_body = RigidMotion::Identity();
  std::optional<Twist> velocity = {};  ///< per second, in the body frame, where it was measured
};

/// Poses over time.
///
///   const Trajectory trajectory(poses);
///   if (const auto T_local_body = trajectory.at(stamp)) use(*T_local_body);
class FOVEA_API Trajectory {
 public:
  /// Longest time before the first pose, after the last one, and into an outage, for which the
  /// velocity of the nearest two poses is trusted.
  static constexpr TimeNs kMaxExtrapolation = kNsPerSecond / 5;
  /// Poses further apart than this are not interpolated: between them is an outage.
  static constexpr TimeNs kMaxGap = kNsPerSecond;

  Trajectory() = default;
  /// Poses in strictly increasing time, at least one; std::invalid_argument otherwise. What repeats
  /// the last place to the bit has frozen, and its velocity with it: that one is dropped.
  explicit Trajectory(std::vector<StampedPose> poses);

  const std::vector<StampedPose>& poses() const { return poses_; }

  /// Appends poses, which follow the last one in strictly increasing time; std::invalid_argument
  /// otherwise.
  void extend(const std::vector<StampedPose>& poses);
  /// Removes the poses before a time, but not the last pose. Returns their number.
  std::size_t drop_before(TimeNs time);

  /// Pose at a time, by the constant twist between neighboring poses. Beyond the ends and in an
  /// outage, by the velocity of the nearest two poses for at most kMaxExtrapolation. A pose between
  /// two outages needs a measured velocity for that; the only pose of a trajectory holds as long.
  /// Empty further out.
  std::optional<RigidMotion> at(TimeNs time) const;

  /// How the body moves at `time`, from what is known by `known_until` (the poses at or before it;
  /// a live program has no later ones). That span is 25 ms at least. Where velocities were measured
  /// no farther from `time` than it: their mean, and its change since those up to three times as
  /// far back, which takes the mean from their time to `time`; a change too large for a vehicle is
  /// left out as a fault. Where none was: the motion between the last pose known and the next that
  /// lies before it by 3/4 of that span or more, without change: poses a span apart, whose times
  /// jitter, are enough, and the noise of closer ones would be divided by a moment. Where fewer
  /// than two poses are that early, or since an outage, the first two of the trajectory or after
  /// the outage. Empty for a single pose and in an outage.
  std::optional<SweepMotion> motion(TimeNs time, TimeNs known_until) const;

 private:
  struct MeanVelocity {
    Twist velocity;
    double time;  // s, about the time asked for
  };
  /// Of what was measured from `begin` on, before `end`.
  std::optional<MeanVelocity> mean_velocity(TimeNs begin, TimeNs end, TimeNs about) const;
  std::optional<SweepMotion> measured_motion(TimeNs time, TimeNs known_until) const;
  void append(const StampedPose& pose);

  std::vector<StampedPose> poses_;
};

}  // namespace fovea
