#include "fovea/mapping/fusion/navigation_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/angle.h"

namespace fovea {
namespace {

/// Differences from the motion of the scans that count as a jump: between two frames (m), plus a
/// share of the path in an outage.
constexpr double kJump = 0.3;
constexpr double kJumpOfPath = 0.01;
constexpr TimeNs kMemory = 60 * kNsPerSecond;
/// Factor of standard deviations. Errors of positions are correlated over tens of seconds, about
/// ten submaps, which together count as one measurement.
constexpr double kCorrelation = 3;
constexpr double kLeastAccuracy = 0.05;   // m
constexpr double kUnknownAccuracy = 0.5;  // m, if the unit states none
constexpr double kHeightFactor = 2;       // of GPS heights over positions
constexpr double kTiltAccuracy = 0.3 * kDegree, kHeadingAccuracy = 1 * kDegree;

}  // namespace

std::string NavigationCheck::observe(TimeNs stamp, const RigidMotion& T_local_lidar) {
  if (navigation_ == nullptr) return "";
  if (last_position_) path_ += (T_local_lidar.translation() - *last_position_).norm();
  last_position_ = T_local_lidar.translation();
  const auto now = navigation_->at(stamp);
  if (!now) return "";
  // Ignores positions before the first fix.
  is_located_ = is_located_ || std::isfinite(accuracy_at(stamp));
  if (!is_located_) return "";
  std::string problem;
  if (last_) {
    // In the axes of navigation, in which its jumps add up.
    const Eigen::Vector3d by_scans = last_->T_local_navigation.linear() *
                                     (last_->T_local_lidar.inverse() * T_local_lidar).translation();
    const Eigen::Vector3d jump =
        now->translation() - last_->T_local_navigation.translation() - by_scans;
    if (jump.norm() > kJump + kJumpOfPath * path_) {
      jumps_.push_back({stamp, jump});
      problem = fmt::format("navigation moves otherwise than the scans by {:.1f} m", jump.norm());
    }
  }
  while (!jumps_.empty() && jumps_.front().stamp < stamp - kMemory) jumps_.pop_front();
  last_ = Known{*now, T_local_lidar};
  path_ = 0;
  return problem;
}

bool NavigationCheck::has_fix() const {
  if (navigation_ == nullptr || navigation_->poses().empty()) return false;
  return accuracy_.empty() || std::any_of(accuracy_.begin(), accuracy_.end(),
                                          [](double accuracy) { return std::isfinite(accuracy); });
}

double NavigationCheck::accuracy_at(TimeNs stamp) const {
  const auto& poses = navigation_->poses();
  const auto after =
      std::upper_bound(poses.begin(), poses.end(), stamp,
                       [](TimeNs time, const StampedPose& pose) { return time < pose.time; });
  const auto index = static_cast<std::size_t>(
      std::max<std::ptrdiff_t>(0, std::distance(poses.begin(), after) - 1));
  return index < accuracy_.size() ? accuracy_[index] : 0;
}

std::optional<double> NavigationCheck::stated_accuracy(TimeNs stamp) const {
  const double stated = navigation_ != nullptr ? accuracy_at(stamp) : 0;
  return stated > 0 ? std::optional(stated) : std::nullopt;
}

std::optional<AbsolutePose> NavigationCheck::measurement(std::size_t node, TimeNs stamp) const {
  if (navigation_ == nullptr) return std::nullopt;
  const auto pose = navigation_->at(stamp);
  if (!pose) return std::nullopt;
  return measurement(node, *pose, accuracy_at(stamp));
}

std::optional<AbsolutePose> NavigationCheck::measurement(std::size_t node,
                                                         const RigidMotion& T_local_lidar,
                                                         double stated) const {
  if (!std::isfinite(stated)) return std::nullopt;
  Eigen::Vector3d jumped = Eigen::Vector3d::Zero();
  for (const Jump& jump : jumps_) jumped += jump.offset;
  const double accuracy =
      kCorrelation * (stated > 0 ? std::max(stated, kLeastAccuracy) : kUnknownAccuracy) +
      jumped.norm();
  AbsolutePose measurement{node, T_local_lidar, Twist::Ones(), /*robust=*/true};
  measurement.sigma << kCorrelation * kTiltAccuracy, kCorrelation * kTiltAccuracy,
      kCorrelation * kHeadingAccuracy, accuracy, accuracy, kHeightFactor * accuracy;
  return measurement;
}

}  // namespace fovea
