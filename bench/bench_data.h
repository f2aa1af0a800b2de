// What the benchmarks work on: frames of a real drive, or of a simulated one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fovea/camera.h"
#include "fovea/drive/frame_source.h"
#include "fovea/point_cloud.h"

namespace fovea::bench {

struct BenchData {
  PointCloud scan_cam;  ///< in view of `camera`, its frame, in the order of the scan
  Camera camera;
  std::vector<std::uint8_t> png;  ///< an image file of that camera
  DriveInfo drive;
  /// One after another, the last of them that of the scan above: as many as a local map holds, and
  /// one more where the drive has as many.
  std::vector<Frame> frames;

  /// Points of a frame's scan, LiDAR frame.
  const std::vector<Eigen::Vector3f>& scan(std::size_t frame) const {
    return frames[frame].scan.position;
  }
};

/// The middle scan of a drive and its first image.
/// @param drive  KITTI drive; empty: the simulated street, made in a temporary folder
/// InputError if the drive cannot be read or has no PNG.
BenchData load_bench_data(const std::string& drive);

}  // namespace fovea::bench
