// KITTI's LiDAR scans: float32 x y z reflectance a point, nothing else.
#pragma once

#include <cstddef>
#include <filesystem>

#include "fovea/base/point_cloud.h"

namespace fovea {

struct KittiScan {
  PointCloud points;        ///< lidar frame, m; with intensity (0-1)
  std::size_t dropped = 0;  ///< points that were not finite or had a coordinate beyond 1 km
};

/// Reads a .bin scan. InputError if the file is empty, its size is no multiple of 16 bytes, or none
/// of its points is usable.
KittiScan read_kitti_scan(const std::filesystem::path& file);

}  // namespace fovea
