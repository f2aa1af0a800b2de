// Whether the images of a drive give the same color to the same surface.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/calibration_view.h"
#include "fovea/mapping/calibration/edge_maximum.h"

namespace fovea {

struct ColorConsistency {
  std::size_t comparisons = 0;
  double difference = 0;  ///< median, as a share of the brightness
  QuadraticTerm term;     ///< log likelihood, in calibration_unit()s about the camera at hand
};

/// Compares the images of neighboring views at the surface points of the first of them. Brightness
/// is relative to its neighborhood, so that exposure drops out. Robust (Cauchy).
/// @param blur  pixels, standard deviation of the Gaussian that smooths the images
ColorConsistency color_consistency(const std::vector<CalibrationView>& views, const Camera& camera,
                                   const PoseSpline& T_local_lidar, double blur);

}  // namespace fovea
