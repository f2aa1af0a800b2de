// What the benchmarks work on: one frame of a real drive, or of a simulated one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/camera.h"

namespace fovea::bench {

struct BenchData {
  PointCloud scan_cam;  ///< in view of `camera`, its frame, in the order of the scan
  Camera camera;
  std::vector<std::uint8_t> png;  ///< an image file of that camera
};

/// The middle scan of a drive and its first image.
/// @param drive  KITTI drive; empty: the simulated street, made in a temporary folder
/// InputError if the drive cannot be read or has no PNG.
BenchData load_bench_data(const std::string& drive);

}  // namespace fovea::bench
