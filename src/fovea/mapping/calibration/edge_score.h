// How well an image's edges meet a LiDAR's under a correction of the calibration.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

using CalibrationMatrix = Eigen::Matrix<double, 6, 6>;

/// What each entry of a correction is measured in below, about a pixel's worth: rad, rad, rad of
/// roll, s, pixels, pixels.
const CalibrationVector& calibration_unit();

/// Sum over edges of the logarithm of the image's edge strength under a Gaussian round where the
/// edge is expected: edges that the image shows weakly count, too. With derivatives by the
/// correction in its units.
struct EdgeScore {
  double value = 0;
  CalibrationVector gradient = CalibrationVector::Zero();
  CalibrationMatrix curvature = CalibrationMatrix::Zero();  ///< of -value
  /// Of a paraboloid that touches the value from below.
  CalibrationMatrix bound = CalibrationMatrix::Zero();

  EdgeScore& operator+=(const EdgeScore& other);
};

/// Score of a correction.
/// @param correction  in calibration_unit()s
/// @param width       standard deviation of the Gaussian (pixels)
EdgeScore edge_score(const EdgeProfile& profile, const CalibrationVector& correction, double width);
EdgeScore edge_score(const std::vector<EdgeProfile>& profiles, const CalibrationVector& correction,
                     double width);

/// The value alone.
double edge_value(const EdgeProfile& profile, const CalibrationVector& correction, double width);

}  // namespace fovea
