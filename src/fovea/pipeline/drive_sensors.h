// The LiDARs of a drive.
#pragma once

#include "fovea/geometry/sensor_profile.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

/// Profile of the drive's LiDAR: what the drive states, and the rest as estimated from the first
/// three usable scans. Reads these frames.
SensorProfile lidar_profile(const FrameSource& source);

}  // namespace fovea
