// Scans of several LiDARs as one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/geometry/sensor_profile.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// Appends the scan of another LiDAR to that of a frame.
/// @param scan_lidar   with times
/// @param scan_sensor  frame of the other LiDAR, with times from its own stamp
/// @param number       of the other LiDAR, for the column `sensor`
/// @param delay        s, from the stamp of the frame to that of the other scan
void append_scan(PointCloud& scan_lidar, PointCloud scan_sensor, std::uint16_t number,
                 const RigidMotion& T_lidar_sensor, double delay);

/// What each LiDAR measured of a scan, in its own frame. Inverse of append_scan().
/// @param lidars  empty: one
std::vector<PointCloud> scans_by_sensor(const PointCloud& scan_lidar,
                                        std::span<const MountedLidar> lidars);

}  // namespace fovea
