// The LiDARs of a drive, and settings derived from them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/geometry/sensor_profile.h"
#include "fovea/pipeline/dynamic_points.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/paper_options.h"

namespace fovea {

/// The drive's LiDARs. Estimates values that the drive does not state from the first two usable
/// scans, and reads these frames.
std::vector<MountedLidar> mounted_lidars(const FrameSource& source);

/// Where the LiDARs of a drive are, m in the frame of the first one.
std::vector<Eigen::Vector3d> lidar_origins(const DriveInfo& drive);

/// Distance of the farthest of these origins from the first LiDAR, m.
double farthest_lidar(const std::vector<Eigen::Vector3d>& lidar_origins);

/// Height of the rows of a LiDAR's range images, rad.
double row_height_of(const SensorProfile& profile);

/// What each LiDAR sees of a deskewed scan.
std::vector<SensorView> sensor_views(const PointCloud& scan_lidar, const DriveInfo& drive);

/// Description of the drive with the profiles of its LiDARs.
DriveInfo info_with_lidars(const FrameSource& source);

/// Sets options that are 0 from the LiDAR: edges of surface, heights and angles.
MapperOptions suited_to(const SensorProfile& profile, MapperOptions options);
/// The same for the LiDAR of a drive whose rings are the farthest apart, with the largest noise of
/// all: surfaces that it alone measures must close, too. For 64 rings if the drive describes no
/// LiDAR.
MapperOptions suited_to(const DriveInfo& drive, const MapperOptions& options);
PaperOptions suited_to(const DriveInfo& drive, PaperOptions options);

/// Height of the first LiDAR over the road, m; the usual one where it is unknown.
double lidar_height(const DriveInfo& drive);

}  // namespace fovea
