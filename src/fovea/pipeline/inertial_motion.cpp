#include "fovea/pipeline/inertial_motion.h"

#include <algorithm>

#include "fovea/core/angle.h"

namespace fovea {
namespace {

Twist sigma_of(double rotation, double translation) {
  Twist sigma;
  sigma.head<3>().setConstant(rotation);
  sigma.tail<3>().setConstant(translation);
  return sigma;
}

/// Least standard deviations of the prediction: rad, m. A tighter prior holds on to a wrong
/// velocity, which distorts the scans to fit it (docs/accuracy.md).
const Twist kLeastSigma = sigma_of(3e-3, 0.03);

/// Standard deviations of a pose from registration: rad, m.
std::optional<Twist> pose_sigma(PoseEvidence evidence) {
  switch (evidence) {
    case PoseEvidence::kFirm:
      return sigma_of(5e-4, 5e-3);
    case PoseEvidence::kWeak:
      return sigma_of(3e-3, 0.1);
    case PoseEvidence::kNone:
      break;
  }
  return std::nullopt;
}

/// Whether a pose is one to which no motion leads, such as after a search.
bool is_jump(const InertialPrediction& prediction, const RigidMotion& T_odom_lidar) {
  constexpr double kSigmas = 5, kLeastShift = 0.5, kLeastTurn = 5 * kDegree;  // m, rad
  const RigidMotion apart = prediction.T_odom_lidar.inverse() * T_odom_lidar;
  const double shift = kSigmas * prediction.sigma.tail<3>().norm();
  const double turn = kSigmas * prediction.sigma.head<3>().norm();
  const bool is_near = apart.translation().norm() <= std::max(kLeastShift, shift) &&
                       rotation_angle(apart.linear()) <= std::max(kLeastTurn, turn);
  return !is_near;  // also where a number is none
}

}  // namespace

std::optional<InertialFilter> InertialMotion::begun(TimeNs stamp,
                                                    const Beginning& beginning) const {
  if (agreement_.is_contradicted() || !filter_.covers(stamp)) return std::nullopt;
  constexpr TimeNs kLongestStep = kNsPerSecond;
  InertialFilter filter = filter_;
  if (filter.has_begun() && stamp - filter.state().time > kLongestStep) filter.restart();
  if (!filter.has_begun()) filter.begin(beginning.time, beginning.start);
  return filter;
}

std::optional<double> InertialMotion::wheel_speed(TimeNs stamp) const {
  constexpr TimeNs kFarthest = kNsPerSecond / 10;
  if (wheels_ == nullptr) return std::nullopt;
  const std::vector<WheelSpeed>& speeds = wheels_->samples;
  const auto later = [](TimeNs time, const WheelSpeed& speed) { return time < speed.time; };
  const auto after = std::upper_bound(speeds.begin(), speeds.end(), stamp, later);
  if (after == speeds.begin() || after == speeds.end()) return std::nullopt;
  const WheelSpeed &a = *std::prev(after), &b = *after;
  if (b.time - a.time > kFarthest) return std::nullopt;
  return a.speed + (b.speed - a.speed) * seconds(stamp - a.time) / seconds(b.time - a.time);
}

InertialPrediction InertialMotion::fused(const InertialFilter& filter, TimeNs stamp,
                                         const std::optional<MotionGuess>& by_nav) const {
  InertialPrediction prediction = filter.predict(stamp);
  if (const auto speed = wheel_speed(stamp)) {
    prediction = filter.corrected(prediction, *speed, wheels_->sigma, wheels_->T_lidar_body);
  }
  if (!by_nav || !by_nav->sigma) return prediction;
  const MotionGuess inertial{prediction.T_odom_lidar, {}, false, {}};
  const double elapsed = seconds(stamp - filter.state().time);
  if (contradict(*by_nav, inertial, elapsed)) return prediction;
  return filter.corrected(prediction, by_nav->T_odom_lidar, *by_nav->sigma);
}

std::optional<MotionGuess> InertialMotion::predict(TimeNs stamp, const SweepSpan& sweep,
                                                   const Beginning& beginning,
                                                   const std::optional<MotionGuess>& by_nav) const {
  const auto filter = begun(stamp, beginning);
  if (!filter) return std::nullopt;
  const InertialPrediction prediction = fused(*filter, stamp, by_nav);
  MotionGuess guess{prediction.T_odom_lidar, filter->motion(prediction, sweep), false, {}};
  if (agreement_.is_proven()) guess.sigma = prediction.sigma.cwiseMax(kLeastSigma);
  return guess;
}

void InertialMotion::compare(TimeNs stamp, const RigidMotion& T_odom_last,
                             const RigidMotion& T_odom_lidar, const RigidMotion& by_velocity) {
  if (!filter_.has_begun() || !filter_.covers(stamp)) return;
  const RigidMotion T_last_odom = T_odom_last.inverse();
  agreement_.add(T_last_odom * T_odom_lidar, T_last_odom * filter_.predict(stamp).T_odom_lidar,
                 T_last_odom * by_velocity);
}

void InertialMotion::update(TimeNs stamp, const RigidMotion& T_odom_lidar, PoseEvidence evidence,
                            const Beginning& beginning, const std::optional<MotionGuess>& by_nav) {
  auto filter = begun(stamp, beginning);
  if (!filter) return filter_.restart();
  const InertialPrediction prediction = fused(*filter, stamp, by_nav);
  filter->update(prediction, T_odom_lidar, pose_sigma(evidence));
  if (is_jump(prediction, T_odom_lidar)) filter->place(prediction, T_odom_lidar);
  filter_ = *filter;
  agreement_.add_bias(filter_.state().rate_bias);
}

}  // namespace fovea
