// The points of the range images that a map keeps.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fovea/map/map_records.h"

namespace fovea {

/// The returns up to a range (m), in the frame of the sensor.
std::vector<Eigen::Vector3f> returns_of(const KeyframeRecord& keyframe, double max_range = 1000);

}  // namespace fovea
