// Agreement of an image's edges with a LiDAR's edges under a correction of the calibration.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

/// Sum over edges of the logarithm of the image's edge strength under a Gaussian at the expected
/// position. The logarithm lets weak edges count. With derivatives by the correction in its units.
struct EdgeScore {
  double value = 0;
  CalibrationVector gradient = CalibrationVector::Zero();
  CalibrationMatrix curvature = CalibrationMatrix::Zero();  ///< of -value
  /// Curvature of a paraboloid that touches the value from below.
  CalibrationMatrix bound = CalibrationMatrix::Zero();

  EdgeScore& operator+=(const EdgeScore& other);
};

/// Score of a correction.
/// @param correction  in calibration_unit()s
/// @param width       standard deviation of the Gaussian (pixels)
EdgeScore edge_score(const EdgeProfile& profile, const CalibrationVector& correction, double width);
EdgeScore edge_score(const std::vector<EdgeProfile>& profiles, const CalibrationVector& correction,
                     double width);

/// The score of one edge and its derivatives by the position along its profile.
struct EdgeSlope {
  double value = 0, slope = 0;
  double curvature = 0, bound = 0;  ///< as in EdgeScore
};
/// @param position  pixels along the profile, from the expected position
EdgeSlope edge_slope(const EdgeProfile& profile, double position, double width);

/// Only the value.
double edge_value(const EdgeProfile& profile, const CalibrationVector& correction, double width);

}  // namespace fovea
