#include "fovea/mapping/calibration/edge_score.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

// Strength of an edge that the image does not show: two objects may have the same color.
constexpr double kFloor = 0.003;

}  // namespace

EdgeSlope edge_slope(const EdgeProfile& profile, double position, double width) {
  // Plus the variance of a uniform distribution: the object ends anywhere in the gap.
  const double variance = width * width + profile.half_gap * profile.half_gap / 3.0;
  const double reach = 3 * std::sqrt(variance);
  // If the profile is out of reach, first > last.
  constexpr int kReach = EdgeProfile::kReach;
  const auto first =
      static_cast<int>(std::clamp<double>(std::ceil(position - reach), -kReach, kReach + 1));
  const auto last =
      static_cast<int>(std::clamp<double>(std::floor(position + reach), -kReach - 1, kReach));
  double mass = 0, moment = 0, square = 0;
  // The Gaussian from pixel to pixel: its ratio changes by a constant factor.
  const double before = first - position;
  double gaussian = std::exp(-before * before / (2 * variance));
  double change = std::exp(-(2 * before + 1) / (2 * variance));
  const double change_of_change = std::exp(-1 / variance);
  for (int k = first; k <= last; ++k) {
    const double away = k - position;
    const int pixel = k + kReach;
    const double seen = profile.strength[static_cast<std::size_t>(pixel)] * gaussian;
    gaussian *= change;
    change *= change_of_change;
    mass += seen;
    moment += seen * away;
    square += seen * away * away;
  }
  const double likelihood = mass + kFloor, slope = moment / variance / likelihood;
  return {std::log(likelihood), slope,
          (mass / variance - square / (variance * variance)) / likelihood + slope * slope,
          mass / variance / likelihood};
}

EdgeScore& EdgeScore::operator+=(const EdgeScore& other) {
  value += other.value;
  gradient += other.gradient;
  curvature += other.curvature;
  bound += other.bound;
  return *this;
}

EdgeScore edge_score(const EdgeProfile& profile, const CalibrationVector& correction,
                     double width) {
  const CalibrationVector J = profile.J_along.cast<double>().cwiseProduct(calibration_unit());
  const EdgeSlope edge = edge_slope(profile, J.dot(correction), width);
  const CalibrationMatrix JJ = J * J.transpose();
  return {edge.value, J * edge.slope, JJ * edge.curvature, JJ * edge.bound};
}

double edge_value(const EdgeProfile& profile, const CalibrationVector& correction, double width) {
  const CalibrationVector J = profile.J_along.cast<double>().cwiseProduct(calibration_unit());
  return edge_slope(profile, J.dot(correction), width).value;
}

EdgeScore edge_score(const std::vector<EdgeProfile>& profiles, const CalibrationVector& correction,
                     double width) {
  return parallel_sum<EdgeScore>(profiles.size(), 512, {}, [&](std::size_t begin, std::size_t end) {
    EdgeScore score;
    for (std::size_t i = begin; i < end; ++i) {
      score += edge_score(profiles[i], correction, width);
    }
    return score;
  });
}

}  // namespace fovea
