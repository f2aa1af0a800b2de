#include "fovea/mapping/calibration/edge_agreement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/mapping/calibration/edge_score.h"
#include "fovea/mapping/calibration/grouped_scatter.h"

namespace fovea {
namespace {

constexpr double kWidth = 1;  // pixels: standard deviation of the Gaussian
// Rotations of the cameras that measure chance agreement, in calibration_unit()s of about a pixel.
// The smallest exceeds any error of the estimate, the largest stays within the profiles.
constexpr std::array<double, 6> kTurns{-16, -12, -8, 8, 12, 16};
constexpr float kMinAcross = 0.5f;  // share of an edge's displacement that is across the edge
constexpr float kClearStep = 0.1f;  // of the strength of a profile
constexpr std::size_t kManyEdges = 60;
// Right calibrations have a contrast of 1.1 to 3.6, wrong ones of -1 to 0.4 about the axis of the
// error (docs/calibration.md).
constexpr double kLeastContrast = 0.8;
constexpr double kSignificant = 2;  // standard deviations
// Minimum gain in the mean logarithm of edge strength over rotated cameras. Drives have 0.7 to 1.3,
// the maximum of clutter up to 0.13, and edges beyond the ends of the profiles up to 0.46
// (docs/calibration.md).
constexpr double kMinGain = 0.5, kFinestWidth = 0.5;
constexpr double kElsewhere = 8;  // pixels

/// Whether a rotation about an axis moves the edge across itself, not along itself.
bool moves_across(const EdgeProfile& profile, int axis) {
  return std::abs(profile.J_along[axis]) > kMinAcross * profile.J.col(axis).norm();
}

bool shows_a_step(const EdgeProfile& profile) {
  return *std::max_element(profile.strength.begin(), profile.strength.end()) > kClearStep;
}

/// Whether the profile covers the neighborhood of the edge under a correction.
bool is_in_profile(const EdgeProfile& profile, const CalibrationVector& correction) {
  const CalibrationVector J = profile.J_along.cast<double>().cwiseProduct(calibration_unit());
  return std::abs(J.dot(correction)) <= EdgeProfile::kReach - 2 * kWidth;
}

}  // namespace

EdgeMean mean_over_edges(const std::vector<const EdgeProfile*>& profiles,
                         const std::vector<double>& values) {
  EdgeMean result;
  result.edges = profiles.size();
  if (profiles.empty()) return result;
  const double n = static_cast<double>(profiles.size());
  for (const double value : values) result.mean += value / n;
  struct Deviation {
    const EdgeProfile* profile;
    double value;
  };
  std::vector<Deviation> deviations;
  deviations.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    deviations.push_back({profiles[i], values[i] - result.mean});
  }
  const auto value = [](const Deviation& d) { return Eigen::Matrix<double, 1, 1>(d.value); };
  const double scatter =
      grouped_scatter(deviations, value, [](const Deviation& d) { return d.profile->frame; })(0) +
      grouped_scatter(deviations, value, [](const Deviation& d) { return d.profile->place; })(0);
  result.sigma = std::sqrt(scatter) / n;
  return result;
}

EdgeMean edge_contrast(const std::vector<EdgeProfile>& profiles, int axis,
                       const CalibrationVector& correction) {
  std::vector<const EdgeProfile*> used;
  std::vector<double> contrasts;
  for (const EdgeProfile& profile : profiles) {
    if (!moves_across(profile, axis) || !shows_a_step(profile)) continue;
    double turned = 0, turns = 0;
    for (const double turn : kTurns) {
      const CalibrationVector other = correction + turn * CalibrationVector::Unit(axis);
      if (!is_in_profile(profile, other)) continue;
      turned += edge_value(profile, other, kWidth);
      ++turns;
    }
    if (turns == 0) continue;
    used.push_back(&profile);
    contrasts.push_back(edge_value(profile, correction, kWidth) - turned / turns);
  }
  return mean_over_edges(used, contrasts);
}

bool edges_disagree(const std::vector<EdgeProfile>& profiles, const CalibrationVector& correction) {
  for (const int axis : {0, 1}) {
    const EdgeMean contrast = edge_contrast(profiles, axis, correction);
    if (contrast.edges >= kManyEdges &&
        contrast.mean + kSignificant * contrast.sigma < kLeastContrast) {
      return true;
    }
  }
  return false;
}

std::array<std::vector<EdgeProfile>, 2> halves_of(const std::vector<EdgeProfile>& profiles) {
  auto middle = profiles.begin() + static_cast<std::ptrdiff_t>(profiles.size() / 2);
  while (middle != profiles.end() && middle->frame == (middle - 1)->frame) ++middle;
  return {std::vector<EdgeProfile>(profiles.begin(), middle),
          std::vector<EdgeProfile>(middle, profiles.end())};
}

bool edges_stand_out(const std::vector<EdgeProfile>& profiles,
                     const CalibrationVector& correction) {
  double elsewhere = 0;
  for (const auto& [axis, sign] : {std::pair{0, -1}, {0, 1}, {1, -1}, {1, 1}}) {
    const CalibrationVector other = correction + sign * kElsewhere * CalibrationVector::Unit(axis);
    elsewhere += edge_score(profiles, other, kFinestWidth).value / 4;
  }
  const double value = edge_score(profiles, correction, kFinestWidth).value;
  return value - elsewhere > kMinGain * static_cast<double>(profiles.size());
}

EdgeMean edge_gain(const std::vector<EdgeProfile>& profiles, const CalibrationVector& correction,
                   const CalibrationVector& other) {
  std::vector<const EdgeProfile*> used;
  std::vector<double> gains;
  for (const EdgeProfile& profile : profiles) {
    used.push_back(&profile);
    gains.push_back(edge_value(profile, correction, kWidth) - edge_value(profile, other, kWidth));
  }
  return mean_over_edges(used, gains);
}

}  // namespace fovea
