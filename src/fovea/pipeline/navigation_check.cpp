#include "fovea/pipeline/navigation_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/base/angle.h"

namespace fovea {
namespace {

/// Navigation that moves otherwise than the scans by more than this between two frames (m), and
/// this share of the path in an outage, has jumped.
constexpr double kJump = 0.3;
constexpr double kJumpOfPath = 0.01;
constexpr TimeNs kMemory = 60 * kNsPerSecond;
/// Errors of a unit's positions stay alike for tens of seconds, about ten submaps: together these
/// count as one.
constexpr double kCorrelation = 3;
constexpr double kLeastAccuracy = 0.05;   // m, whatever the unit says
constexpr double kUnknownAccuracy = 0.5;  // m, where it says nothing
constexpr double kHeightFactor = 2;       // GPS knows heights half as well
constexpr double kTiltAccuracy = 0.3 * kDegree, kHeadingAccuracy = 1 * kDegree;

}  // namespace

std::string NavigationCheck::observe(TimeNs stamp, const RigidMotion& T_local_lidar) {
  if (navigation_ == nullptr) return "";
  if (last_position_) path_ += (T_local_lidar.translation() - *last_position_).norm();
  last_position_ = T_local_lidar.translation();
  const auto now = navigation_->at(stamp);
  if (!now) return "";
  // Positions before the first fix are no reason to doubt it.
  is_located_ = is_located_ || std::isfinite(accuracy_at(stamp));
  if (!is_located_) return "";
  std::string problem;
  if (last_) {
    // Compared in the axes of navigation, that jumps of it add up there.
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
  if (navigation_ == nullptr) return false;
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

std::optional<AbsolutePose> NavigationCheck::measurement(std::size_t node, TimeNs stamp) const {
  if (navigation_ == nullptr) return std::nullopt;
  const auto pose = navigation_->at(stamp);
  const double stated = accuracy_at(stamp);
  if (!pose || !std::isfinite(stated)) return std::nullopt;
  Eigen::Vector3d jumped = Eigen::Vector3d::Zero();
  for (const Jump& jump : jumps_) jumped += jump.way;
  const double accuracy =
      kCorrelation * (stated > 0 ? std::max(stated, kLeastAccuracy) : kUnknownAccuracy) +
      jumped.norm();
  AbsolutePose measurement{node, *pose, Twist::Ones(), /*robust=*/true};
  measurement.sigma << kCorrelation * kTiltAccuracy, kCorrelation * kTiltAccuracy,
      kCorrelation * kHeadingAccuracy, accuracy, accuracy, kHeightFactor * accuracy;
  return measurement;
}

}  // namespace fovea
