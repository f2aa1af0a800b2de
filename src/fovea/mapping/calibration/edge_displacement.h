// How far a correction moves edges in the image.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/edge_profiles.h"

namespace fovea {

/// Medians over edges, pixels.
struct EdgeDisplacement {
  double pixels = 0;
  double sigma = 0;  ///< standard deviation
};

/// @param correction, covariance  in calibration_unit()s
EdgeDisplacement edge_displacement(const std::vector<EdgeProfile>& profiles,
                                   const CalibrationVector& correction,
                                   const CalibrationMatrix& covariance);

}  // namespace fovea
