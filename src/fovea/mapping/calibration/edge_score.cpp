#include "fovea/mapping/calibration/edge_score.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

// Strength of an edge that the image does not show: two objects may have the same color.
constexpr double kFloor = 0.003;

/// Contribution of one edge to a score, before the products of its derivative.
struct EdgeTerms {
  CalibrationVector J;  ///< of its position along the profile
  double value, slope, curvature, bound;

  void add_to(EdgeScore& score) const {
    const CalibrationMatrix JJ = J * J.transpose();
    score.value += value;
    score.gradient += J * slope;
    score.curvature += JJ * curvature;
    score.bound += JJ * bound;
  }
};

EdgeTerms terms_of(const EdgeProfile& profile, const CalibrationVector& correction, double width) {
  const CalibrationVector J = profile.J_along.cast<double>().cwiseProduct(calibration_unit());
  const double position = J.dot(correction);
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
  return {J, std::log(likelihood), slope,
          (mass / variance - square / (variance * variance)) / likelihood + slope * slope,
          mass / variance / likelihood};
}

}  // namespace

const CalibrationVector& calibration_unit() {
  static const CalibrationVector unit =
      (CalibrationVector() << 0.0014, 0.0014, 0.01, 0.01, 1, 1).finished();
  return unit;
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
  EdgeScore score;
  terms_of(profile, correction, width).add_to(score);
  return score;
}

double edge_value(const EdgeProfile& profile, const CalibrationVector& correction, double width) {
  return terms_of(profile, correction, width).value;
}

EdgeScore edge_score(const std::vector<EdgeProfile>& profiles, const CalibrationVector& correction,
                     double width) {
  return parallel_sum<EdgeScore>(profiles.size(), 512, {}, [&](std::size_t begin, std::size_t end) {
    EdgeScore score;
    for (std::size_t i = begin; i < end; ++i) {
      terms_of(profiles[i], correction, width).add_to(score);
    }
    return score;
  });
}

}  // namespace fovea
