// A LiDAR in words.
#pragma once

#include <string>

#include "fovea/geometry/sensor_profile.h"

namespace fovea::app {

/// Rings, spacing, sweeps, noise and height.
std::string to_text(const SensorProfile& profile);

}  // namespace fovea::app
