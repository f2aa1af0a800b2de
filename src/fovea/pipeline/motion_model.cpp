#include "fovea/pipeline/motion_model.h"

#include <algorithm>

#include "fovea/core/angle.h"

namespace fovea {
namespace {

/// A pause of the recording is a step between frames longer than kPause and kPauseSteps usual
/// steps.
constexpr TimeNs kPause = kNsPerSecond;
constexpr int kPauseSteps = 3;

/// A guess in place of that of the IMU must fit better by this factor: the IMU is rarely wrong.
constexpr double kLeastGain = 1.1;

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

Twist squares(double rotation, double translation) {
  Twist squares;
  squares.head<3>().setConstant(rotation * rotation);
  squares.tail<3>().setConstant(translation * translation);
  return squares;
}

Twist velocity_between(const StampedPose& a, const StampedPose& b) {
  return fovea::velocity_between(a.T_local_body, b.T_local_body, seconds(b.time - a.time));
}

}  // namespace

MotionModel::MotionModel(const MotionSources& sources, const MotionModelOptions& options)
    : navigation_(sources.navigation), options_(options) {
  if (sources.imu != nullptr) inertial_.emplace(*sources.imu, sources.wheels);
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

InertialMotion::Beginning MotionModel::beginning(TimeNs stamp) const {
  InertialMotion::Beginning beginning;
  const auto navigation = navigation_at(stamp);
  InertialStart& start = beginning.start;
  start.velocity = motion_velocity();
  if (last_) {
    beginning.time = last_->time;
    start.T_odom_lidar = last_->T_local_body;
    return beginning;
  }
  beginning.time = stamp;
  start.T_odom_lidar = navigation.value_or(RigidMotion::Identity());
  start.is_level = options_.navigation_is_level && navigation.has_value();
  if (const auto motion = navigation_motion(stamp)) start.velocity = motion->velocity;
  return beginning;
}

std::optional<MotionGuess> MotionModel::by_imu(TimeNs stamp, const SweepSpan& sweep,
                                               const std::optional<MotionGuess>& by_nav) const {
  if (!inertial_) return std::nullopt;
  return inertial_->predict(stamp, sweep, beginning(stamp), by_nav);
}

std::string MotionModel::fault_of_imu() const {
  if (!inertial_ || !inertial_->agreement().is_contradicted()) return "";
  return inertial_->agreement().likely_fault();
}

MotionPrediction MotionModel::predict_after_pause(TimeNs stamp) const {
  MotionPrediction prediction;
  prediction.after_pause = true;
  prediction.T_local_lidar_navigation = navigation_at(stamp);
  auto guess = by_navigation(stamp);
  if (guess) {
    guess->sigma.reset();  // unknown over the pause
  } else {
    guess = MotionGuess{last_->T_local_body, navigation_motion(stamp), false, std::nullopt};
    if (!guess->motion && initial_velocity_) guess->motion = SweepMotion{*initial_velocity_};
  }
  prediction.guesses = {*guess};
  return prediction;
}

MotionPrediction MotionModel::predict(TimeNs stamp, const SweepSpan& sweep) const {
  if (follows_pause(stamp)) return predict_after_pause(stamp);
  MotionPrediction prediction;
  prediction.T_local_lidar_navigation = navigation_at(stamp);
  auto by_nav = by_navigation(stamp);
  const auto by_motion = by_velocity(stamp);
  if (const auto inertial = by_imu(stamp, sweep, by_nav)) {
    prediction.guesses = {*inertial};
    const auto add_if_other = [&](std::optional<MotionGuess> guess) {
      if (!guess || !last_ || !contradict(*guess, *inertial, seconds(stamp - last_->time))) return;
      guess->sigma.reset();  // registration decides
      prediction.guesses.push_back(*guess);
    };
    if (options_.doubt) add_if_other(by_nav);
    if (!inertial_->agreement().is_proven()) add_if_other(by_motion);
    prediction.least_gain = kLeastGain;
    return prediction;
  }
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
  if (inertial_ && follows_pause(stamp)) {
    inertial_->restart();  // it begins again at this frame
  } else if (inertial_) {
    const auto by_motion = by_velocity(stamp);
    if (last_ && by_motion && evidence == PoseEvidence::kFirm) {
      inertial_->compare(stamp, last_->T_local_body, T_odom_lidar, by_motion->T_odom_lidar);
    }
    inertial_->update(stamp, T_odom_lidar, evidence, beginning(stamp), by_navigation(stamp));
  }
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
