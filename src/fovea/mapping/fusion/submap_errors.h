// Standard deviations of the relative poses of submaps.
#pragma once

#include "fovea/rigid_motion.h"

namespace fovea {

/// Of the odometry between the origins of consecutive submaps.
/// @param length       m driven between them
/// @param weak_frames  frames between them with degenerate or failed registration
Twist odometry_deviations(double length, int weak_frames);

/// Of the unknown motion over a pause after which the track restarts.
Twist restart_deviations();

/// Of a loop closure.
Twist loop_deviations();

}  // namespace fovea
