// LiDAR scans without a header: float32 values and nothing else.
#pragma once

#include "fovea/core/input_file.h"
#include "fovea/drive/scans/lidar_scan.h"

namespace fovea {

/// Reads a .bin scan: x y z reflectance (KITTI, 16 bytes per point) or x y z intensity ring
/// (nuScenes, 20 bytes). The content decides which, see numbers_per_point(); a file with too few
/// points to decide is KITTI's if its size fits. InputError if the file is empty, has points of
/// another size, is cut short, or none of its points is usable.
LidarScan read_kitti_scan(const InputFile& file);
LidarScan read_kitti_scan(const std::filesystem::path& file);

/// The same points as rows with the columns x, y, z, intensity and, of 20 bytes, ring, in the
/// file's units.
void read_kitti_rows(const InputFile& file, CloudRows& rows);

}  // namespace fovea
