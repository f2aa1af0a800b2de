// The LiDARs of a drive, and settings derived from them.
#pragma once

#include "fovea/drive/frame_source.h"
#include "fovea/geometry/sensor_profile.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/paper_options.h"

namespace fovea {

/// Profile of the drive's LiDAR. Estimates values that the drive does not state from the first two
/// usable scans, and reads these frames.
SensorProfile lidar_profile(const FrameSource& source);

/// Description of the drive with the profiles of its LiDARs.
DriveInfo info_with_lidars(const FrameSource& source);

/// Sets options that are 0 from the LiDAR: edges of surface, heights and angles.
MapperOptions suited_to(const SensorProfile& profile, MapperOptions options);
/// The same for the first LiDAR of a drive; for 64 rings if the drive describes none.
MapperOptions suited_to(const DriveInfo& drive, const MapperOptions& options);
PaperOptions suited_to(const DriveInfo& drive, PaperOptions options);

/// Height of the first LiDAR over the road, m; the usual one where it is unknown.
double lidar_height(const DriveInfo& drive);

}  // namespace fovea
