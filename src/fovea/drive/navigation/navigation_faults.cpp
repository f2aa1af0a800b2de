#include "fovea/drive/navigation/navigation_faults.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "fovea/core/angle.h"
#include "fovea/core/median.h"

namespace fovea {
namespace {

constexpr double kStep = 2;  // m, between samples, by navigation or by scans
/// m, by scans. Navigation may drift while a vehicle stands.
constexpr double kLeastStep = 0.2;
constexpr std::size_t kMinSteps = 4, kMaxSamples = 2000;
// Median relative difference of steps: that of lengths plus a quarter of that of rotations. Right
// navigation has below 0.05, wrong units and directions above 0.5.
constexpr double kTurnWeight = 0.25, kLeastTurn = 2 * kDegree;
constexpr double kWrong = 0.25, kExplained = 0.12, kTie = 0.02;
// A wrong position of the LiDAR affects turns: median difference of positions across a turn.
constexpr double kTurn = 20 * kDegree, kWrongPlace = 0.3;  // m
constexpr double kPlaceResidual = 1.0 / 3;                 // of the difference
constexpr std::size_t kFarthestTurn = 50;                  // samples: positions drift over more

double difference(const NavigationSteps& steps) {
  std::vector<double> shares;
  for (const NavigationStep& step : steps) {
    const RigidMotion navigation = step.by_navigation(), &scans = step.T_first_last;
    const double length = std::max(navigation.translation().norm(), scans.translation().norm()),
                 turn = std::max({rotation_angle(navigation.linear()),
                                  rotation_angle(scans.linear()), kLeastTurn});
    const RigidMotion apart = navigation.inverse() * scans;
    shares.push_back(apart.translation().norm() / length +
                     kTurnWeight * rotation_angle(apart.linear()) / turn);
  }
  return median_of(std::move(shares));
}

/// Median, m.
double difference_of_positions(const NavigationSteps& steps) {
  std::vector<double> differences;
  for (const NavigationStep& step : steps) {
    differences.push_back(
        (step.by_navigation().translation() - step.T_first_last.translation()).norm());
  }
  return median_of(std::move(differences));
}

/// Errors that explain the difference: the most likely one, and others of similar likelihood.
std::vector<std::string> likely_errors(const std::vector<NavigationRepair>& repairs) {
  std::vector<std::pair<double, std::string>> errors;
  for (const NavigationRepair& repair : repairs) {
    const double rest = difference(repair.steps);
    if (rest < kExplained) errors.emplace_back(rest, repair.error);
  }
  std::sort(errors.begin(), errors.end());
  std::vector<std::string> names;
  for (const auto& [rest, error] : errors) {
    const bool is_new = std::find(names.begin(), names.end(), error) == names.end();
    if (is_new && rest < 2 * errors.front().first + kTie) names.push_back(error);
  }
  return names;
}

}  // namespace

void NavigationFaults::add(const RigidMotion& T_local_lidar, const RigidMotion& T_odom_lidar) {
  const Sample sample{T_local_lidar, T_odom_lidar, !is_interrupted_};
  if (sample.is_joined) {
    const Sample& last = samples_.back();
    const auto is_near = [](const RigidMotion& a, const RigidMotion& b) {
      return (a.translation() - b.translation()).norm() < kStep;
    };
    if (is_near(sample.T_local_lidar, last.T_local_lidar) &&
        is_near(sample.T_odom_lidar, last.T_odom_lidar)) {
      return;
    }
  }
  if (samples_.size() == kMaxSamples) return;
  samples_.push_back(sample);
  is_interrupted_ = false;
}

NavigationStep NavigationFaults::step_between(const Sample& first, const Sample& last) {
  return {first.T_local_lidar, last.T_local_lidar,
          first.T_odom_lidar.inverse() * last.T_odom_lidar};
}

NavigationSteps NavigationFaults::steps() const {
  NavigationSteps steps;
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    if (!samples_[i].is_joined) continue;
    const NavigationStep step = step_between(samples_[i - 1], samples_[i]);
    if (step.T_first_last.translation().norm() >= kLeastStep) steps.push_back(step);
  }
  return steps;
}

NavigationSteps NavigationFaults::turns() const {
  NavigationSteps turns;
  for (std::size_t first = 0; first < samples_.size(); ++first) {
    const std::size_t end = std::min(samples_.size(), first + kFarthestTurn);
    for (std::size_t last = first + 1; last < end && samples_[last].is_joined; ++last) {
      const NavigationStep step = step_between(samples_[first], samples_[last]);
      if (rotation_angle(step.T_first_last.linear()) < kTurn) continue;
      turns.push_back(step);
      break;
    }
  }
  return turns;
}

std::optional<std::string> NavigationFaults::likely_cause() const {
  const NavigationSteps steps = this->steps();
  if (steps.size() < kMinSteps) return std::nullopt;
  const RigidMotion T_body_lidar = drive_.calibration.T_imu_lidar.value_or(RigidMotion::Identity());
  std::vector<std::string> errors;
  if (difference(steps) >= kWrong) {
    std::vector<NavigationRepair> repairs{repaired_place(steps, T_body_lidar)};
    if (drive_.origin) {
      for (NavigationRepair& repair : repaired_positions(steps, *drive_.origin, T_body_lidar)) {
        repairs.push_back(std::move(repair));
      }
    } else {
      repairs.push_back(repaired_inversion(steps, T_body_lidar));
    }
    errors = likely_errors(repairs);
    if (errors.empty()) errors = likely_errors({repaired_scale(steps), repaired_turn(steps)});
  } else if (const NavigationSteps turns = this->turns(); turns.size() >= kMinSteps) {
    const double as_given = difference_of_positions(turns);
    const NavigationRepair place = repaired_place(turns, T_body_lidar);
    const double rest = difference_of_positions(place.steps);
    if (as_given > kWrongPlace && rest < kPlaceResidual * as_given) errors = {place.error};
  }
  if (errors.empty()) return std::nullopt;
  return fmt::format("navigation does not fit the scans; likely cause: {}",
                     fmt::join(errors, ", or "));
}

}  // namespace fovea
