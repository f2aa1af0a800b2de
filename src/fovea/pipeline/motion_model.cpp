#include "fovea/pipeline/motion_model.h"

#include <algorithm>

#include "fovea/core/angle.h"

namespace fovea {
namespace {

/// Largest difference between the motions of two frames. A vehicle's acceleration and yaw
/// acceleration are lower, and the constant parts exceed the errors of registration and GPS.
constexpr double kAcceleration = 10, kShift = 0.2;                          // m/s^2, m
constexpr double kRotationRate = 100 * kDegree, kRotation = 1.5 * kDegree;  // rad/s^2, rad

/// A pause of the recording is a step between frames longer than kPause and kPauseSteps usual
/// steps.
constexpr TimeNs kPause = kNsPerSecond;
constexpr int kPauseSteps = 3;

/// Initial error of a velocity, and the largest value of a single error. The limit keeps a short
/// loss of satellites from reducing the weight of navigation for long.
constexpr double kFirstTranslation = 0.1, kFirstRotation = 0.5 * kDegree;  // m/s, rad/s
constexpr double kMaxTranslation = 1, kMaxRotation = 5 * kDegree;          // m/s, rad/s
constexpr int kRemembered = 10;                                            // frames

/// Least standard deviations of navigation's motion between frames. That of positions is a quarter
/// of their stated accuracy, within limits, since errors of consecutive positions are similar.
constexpr double kLeastRotationSigma = 0.3 * kDegree;                      // rad
constexpr double kMinTranslationSigma = 0.03, kMaxTranslationSigma = 0.1;  // m
constexpr double kTranslationSigmaShare = 0.25;                            // of the stated accuracy

/// Least standard deviations of the IMU's motion between frames: rad, m.
const Twist kLeastInertialSigma =
    (Twist() << Twist::Constant(1e-3).head<3>(), Twist::Constant(0.01).head<3>()).finished();

Twist squares(double rotation, double translation) {
  Twist squares;
  squares.head<3>().setConstant(rotation * rotation);
  squares.tail<3>().setConstant(translation * translation);
  return squares;
}

/// Standard deviations of a pose from registration: rad, m.
std::optional<Twist> pose_sigma(PoseEvidence evidence) {
  switch (evidence) {
    case PoseEvidence::kFirm:
      return squares(5e-4, 5e-3).cwiseSqrt();
    case PoseEvidence::kWeak:
      return squares(3e-3, 0.1).cwiseSqrt();
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
  return apart.translation().norm() > std::max(kLeastShift, shift) ||
         rotation_angle(apart.linear()) > std::max(kLeastTurn, turn);
}

Twist velocity_between(const StampedPose& a, const StampedPose& b) {
  return fovea::velocity_between(a.T_local_body, b.T_local_body, seconds(b.time - a.time));
}

bool contradict(const MotionGuess& a, const MotionGuess& b, double elapsed) {
  const double shift = kShift + kAcceleration * elapsed * elapsed;
  const double turn = kRotation + kRotationRate * elapsed * elapsed;
  const RigidMotion apart = a.T_odom_lidar.inverse() * b.T_odom_lidar;
  if (apart.translation().norm() > shift || rotation_angle(apart.linear()) > turn) return true;
  if (!a.motion || !b.motion) return false;
  const Twist change = (a.motion->velocity - b.motion->velocity) * elapsed;
  return change.tail<3>().norm() > shift || change.head<3>().norm() > turn;
}

}  // namespace

MotionModel::MotionModel(const MotionSources& sources, const MotionModelOptions& options)
    : sources_(sources), navigation_(sources.navigation), options_(options) {
  if (sources.imu != nullptr) filter_.emplace(*sources.imu);
}

Twist VelocityError::before_any() { return squares(kFirstRotation, kFirstTranslation); }

void VelocityError::add(const Twist& predicted, const Twist& actual) {
  count_ = std::min(count_ + 1, kRemembered);
  const Twist square =
      (predicted - actual).cwiseAbs2().cwiseMin(squares(kMaxRotation, kMaxTranslation));
  mean_square_ += (square - mean_square_) / count_;
}

std::optional<RigidMotion> MotionModel::navigation_at(TimeNs stamp) const {
  if (navigation_ == nullptr) return std::nullopt;
  return navigation_->at(stamp);
}

std::optional<SweepMotion> MotionModel::navigation_motion(TimeNs stamp) const {
  if (navigation_ == nullptr) return std::nullopt;
  return navigation_->motion(stamp, stamp + options_.sweep_rest);
}

std::optional<Twist> MotionModel::motion_velocity() const {
  if (!before_last_) return initial_velocity_;
  return velocity_between(*before_last_, *last_);
}

std::optional<MotionGuess> MotionModel::by_navigation(TimeNs stamp) const {
  const auto now = navigation_at(stamp);
  if (!now) return std::nullopt;
  const auto motion = navigation_motion(stamp);
  if (!last_) return MotionGuess{*now, motion, true, std::nullopt};
  const auto then = navigation_at(last_->time);
  if (!then) return std::nullopt;
  return MotionGuess{last_->T_local_body * (then->inverse() * *now), motion, true,
                     navigation_sigma(seconds(stamp - last_->time))};
}

std::optional<MotionGuess> MotionModel::by_velocity(TimeNs stamp) const {
  const auto velocity = motion_velocity();
  if (!velocity) return std::nullopt;
  MotionGuess guess{RigidMotion::Identity(), SweepMotion{*velocity}, false, std::nullopt};
  if (!last_) return guess;
  guess.T_odom_lidar = last_->T_local_body * exp_se3(*velocity * seconds(stamp - last_->time));
  // Rounding errors would otherwise double every frame.
  guess.T_odom_lidar.linear() = nearest_rotation(guess.T_odom_lidar.linear());
  return guess;
}

Twist MotionModel::navigation_sigma(double elapsed) const {
  const double stated = options_.stated_accuracy;
  const double translation = stated > 0 ? std::clamp(kTranslationSigmaShare * stated,
                                                     kMinTranslationSigma, kMaxTranslationSigma)
                                        : kMaxTranslationSigma;
  const Twist least = squares(kLeastRotationSigma, translation);
  return (least + navigation_error_.mean_square() * elapsed * elapsed).cwiseSqrt();
}

/// The weighted mean of two independent measurements.
SweepMotion MotionModel::weighed(const SweepMotion& by_navigation,
                                 const SweepMotion& by_motion) const {
  const Twist &navigation = navigation_error_.mean_square(), &motion = motion_error_.mean_square();
  const auto mean = [&](const Twist& of_navigation, const Twist& of_motion) -> Twist {
    return (motion.cwiseProduct(of_navigation) + navigation.cwiseProduct(of_motion))
        .cwiseQuotient(navigation + motion);
  };
  return {mean(by_navigation.velocity, by_motion.velocity),
          mean(by_navigation.acceleration, by_motion.acceleration)};
}

bool MotionModel::follows_pause(TimeNs stamp) const {
  if (!last_) return false;
  const TimeNs step = stamp - last_->time;
  return step > kPause && (!usual_step_ || step > kPauseSteps * *usual_step_);
}

std::optional<InertialFilter> MotionModel::filter_for(TimeNs stamp) const {
  if (!filter_ || !filter_->covers(stamp)) return std::nullopt;
  InertialFilter filter = *filter_;
  if (filter.has_begun()) return filter;
  const auto navigation = navigation_at(stamp);
  InertialStart start;
  start.velocity = motion_velocity();
  start.is_level = options_.navigation_is_level && navigation.has_value();
  if (last_) {
    start.T_odom_lidar = last_->T_local_body;
    filter.begin(last_->time, start);
  } else {
    start.T_odom_lidar = navigation.value_or(RigidMotion::Identity());
    if (const auto motion = navigation_motion(stamp)) start.velocity = motion->velocity;
    filter.begin(stamp, start);
  }
  return filter;
}

std::optional<double> MotionModel::wheel_speed(TimeNs stamp) const {
  constexpr TimeNs kFarthest = kNsPerSecond / 10;
  if (sources_.wheels == nullptr) return std::nullopt;
  const std::vector<WheelSpeed>& speeds = sources_.wheels->samples;
  const auto later = [](TimeNs time, const WheelSpeed& speed) { return time < speed.time; };
  const auto after = std::upper_bound(speeds.begin(), speeds.end(), stamp, later);
  if (after == speeds.begin() || after == speeds.end()) return std::nullopt;
  const WheelSpeed &a = *std::prev(after), &b = *after;
  if (b.time - a.time > kFarthest) return std::nullopt;
  return a.speed + (b.speed - a.speed) * seconds(stamp - a.time) / seconds(b.time - a.time);
}

InertialPrediction MotionModel::fused(const InertialFilter& filter, TimeNs stamp,
                                      const std::optional<MotionGuess>& by_nav) const {
  InertialPrediction prediction = filter.predict(stamp);
  if (const auto speed = wheel_speed(stamp)) {
    const WheelData& wheels = *sources_.wheels;
    prediction = filter.corrected(prediction, *speed, wheels.sigma, wheels.T_lidar_body);
  }
  if (!last_ || !by_nav || !by_nav->sigma) return prediction;
  const MotionGuess inertial{prediction.T_odom_lidar, {}, false, {}};
  if (contradict(*by_nav, inertial, seconds(stamp - last_->time))) return prediction;
  return filter.corrected(prediction, by_nav->T_odom_lidar, *by_nav->sigma);
}

std::optional<MotionGuess> MotionModel::by_imu(TimeNs stamp, const SweepSpan& sweep,
                                               const std::optional<MotionGuess>& by_nav) const {
  const auto filter = filter_for(stamp);
  if (!filter) return std::nullopt;
  const InertialPrediction prediction = fused(*filter, stamp, by_nav);
  MotionGuess guess{prediction.T_odom_lidar, filter->motion(prediction, sweep), false, {}};
  if (last_) guess.sigma = prediction.sigma.cwiseMax(kLeastInertialSigma);
  return guess;
}

void MotionModel::update_filter(TimeNs stamp, const RigidMotion& T_odom_lidar,
                                PoseEvidence evidence) {
  if (!filter_) return;
  auto filter = filter_for(stamp);
  if (!filter) {
    filter_->restart();
    return;
  }
  const InertialPrediction prediction = fused(*filter, stamp, by_navigation(stamp));
  filter->update(prediction, T_odom_lidar, pose_sigma(evidence));
  if (is_jump(prediction, T_odom_lidar)) filter->restart();
  filter_ = std::move(filter);
}

MotionPrediction MotionModel::predict_after_pause(TimeNs stamp, const SweepSpan& sweep) const {
  MotionPrediction prediction;
  prediction.after_pause = true;
  prediction.T_local_lidar_navigation = navigation_at(stamp);
  auto guess = by_navigation(stamp);
  if (guess) {
    guess->sigma.reset();  // unknown over the pause
  } else if ((guess = by_imu(stamp, sweep, std::nullopt))) {
    guess->sigma.reset();  // the speed may have changed much
  } else {
    guess = MotionGuess{last_->T_local_body, navigation_motion(stamp), false, std::nullopt};
    if (!guess->motion && initial_velocity_) guess->motion = SweepMotion{*initial_velocity_};
  }
  prediction.guesses = {*guess};
  return prediction;
}

MotionPrediction MotionModel::predict(TimeNs stamp, const SweepSpan& sweep) const {
  if (follows_pause(stamp)) return predict_after_pause(stamp, sweep);
  MotionPrediction prediction;
  prediction.T_local_lidar_navigation = navigation_at(stamp);
  auto by_nav = by_navigation(stamp);
  if (const auto inertial = by_imu(stamp, sweep, by_nav)) {
    prediction.guesses = {*inertial};
    if (by_nav && last_ && options_.doubt &&
        contradict(*by_nav, *inertial, seconds(stamp - last_->time))) {
      by_nav->sigma.reset();  // registration decides
      prediction.guesses.push_back(*by_nav);
    }
    return prediction;
  }
  const auto by_motion = by_velocity(stamp);
  if (by_nav && by_motion && options_.doubt) {
    if (contradict(*by_nav, *by_motion, seconds(stamp - last_->time))) {
      by_nav->sigma.reset();  // registration decides
      prediction.guesses = {*by_motion, *by_nav};
      return prediction;
    }
    by_nav->motion =
        by_nav->motion ? weighed(*by_nav->motion, *by_motion->motion) : by_motion->motion;
  }
  if (by_nav) {
    prediction.guesses = {*by_nav};
  } else if (by_motion) {
    prediction.guesses = {*by_motion};
  } else {
    prediction.guesses = {{last_ ? last_->T_local_body : RigidMotion::Identity(), {}, false, {}}};
  }
  return prediction;
}

void MotionModel::update(TimeNs stamp, const RigidMotion& T_odom_lidar, PoseEvidence evidence) {
  const StampedPose now{stamp, T_odom_lidar};
  update_filter(stamp, T_odom_lidar, evidence);
  const bool is_after_pause = follows_pause(stamp);
  if (last_ && !(is_after_pause && usual_step_)) usual_step_ = stamp - last_->time;
  if (is_after_pause) {
    last_.reset();
    before_last_.reset();
  }
  if (before_last_) {
    const Twist actual = velocity_between(*before_last_, now);  // at last_, between the two
    if (last_by_navigation_) navigation_error_.add(last_by_navigation_->velocity, actual);
    if (last_by_motion_) motion_error_.add(*last_by_motion_, actual);
  }
  last_by_navigation_ = navigation_motion(stamp);
  last_by_motion_ = motion_velocity();
  before_last_ = last_;
  last_ = now;
  if (before_last_) initial_velocity_.reset();
}

}  // namespace fovea
