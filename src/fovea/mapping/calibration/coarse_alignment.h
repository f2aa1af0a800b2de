// Large corrections of a camera's calibration, by search.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/calibration_view.h"

namespace fovea {

/// Covers errors of 6 degrees about each axis and 120 ms; translations follow from the best of
/// these. Searches for corrections under which the LiDAR's edges lie near the images' edges: a grid
/// of rotations and delays on smoothed images, then steps downhill on ever finer images.
/// @return  corrections near maxima, the best first; empty if there are no edges
std::vector<CameraCorrection> coarse_corrections(const std::vector<CalibrationView>& views,
                                                 const Camera& camera,
                                                 const PoseSpline& T_local_lidar);

}  // namespace fovea
