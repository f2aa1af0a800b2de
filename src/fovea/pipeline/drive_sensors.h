// The LiDARs of a drive, and the settings that suit them.
#pragma once

#include "fovea/geometry/sensor_profile.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

/// Profile of the drive's LiDAR: what the drive states, and the rest as estimated from the first
/// two usable scans. Reads these frames.
SensorProfile lidar_profile(const FrameSource& source);

/// What is known of the drive, with the profiles of its LiDARs.
DriveInfo info_with_lidars(const FrameSource& source);

/// Sets what the options leave to the LiDAR: edges of surface, heights and angles that are 0.
MapperOptions suited_to(const SensorProfile& profile, MapperOptions options);
/// The same for the first LiDAR of a drive; of one whose LiDARs are not known, for 64 rings.
MapperOptions suited_to(const DriveInfo& drive, const MapperOptions& options);

}  // namespace fovea
