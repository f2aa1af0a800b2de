// KITTI's LiDAR scans: float32 x y z reflectance a point, nothing else.
#pragma once

#include <filesystem>

#include "fovea/sensor/lidar_scan.h"

namespace fovea {

/// Reads a .bin scan. InputError if the file is empty, its size is no multiple of 16 bytes, or none
/// of its points is usable.
LidarScan read_kitti_scan(const std::filesystem::path& file);

/// The same points as rows with the columns x, y, z and intensity, in the file's units.
void read_kitti_rows(const std::filesystem::path& file, CloudRows& rows);

}  // namespace fovea
