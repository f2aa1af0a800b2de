// All six extrinsic parameters and the delay of a camera, from errors of several degrees.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/calibration_estimate.h"
#include "fovea/mapping/calibration/calibration_view.h"

namespace fovea {

/// Estimates the correction of a camera, from coarse to fine: a search on smoothed edges, then the
/// edges of the LiDAR in the images together with the colors of surfaces that several images show.
/// A value is observable if its standard deviation is below a limit. The others stay as given.
/// @param views  in the order of time. Images of views up to 6 m apart are compared with each other
CalibrationEstimate estimate_extrinsics(const std::vector<CalibrationView>& views,
                                        const Camera& camera, const PoseSpline& T_local_lidar);

}  // namespace fovea
