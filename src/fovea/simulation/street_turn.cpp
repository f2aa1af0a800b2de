#include "fovea/simulation/street_turn.h"

#include <cmath>
#include <numbers>

namespace fovea {

double turn_heading(double u) {
  return 0.5 * std::numbers::pi * (u - std::sin(2 * std::numbers::pi * u) / (2 * std::numbers::pi));
}

double turn_curvature(double into, double length) {
  return 0.5 * std::numbers::pi / length * (1 - std::cos(2 * std::numbers::pi * into / length));
}

double turn_length() {
  double mean = 0;  // of the cosine of the heading: the share of a turn's length that leads ahead
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) mean += std::cos(turn_heading((k + 0.5) / kSteps)) / kSteps;
  return kCorner / mean;
}

}  // namespace fovea
