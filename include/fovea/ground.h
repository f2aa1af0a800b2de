// Ground segmentation (paper: Pose Refinement, "z thresholding ... RANSAC").
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

enum class GroundMethod { kHeight, kRansac };

struct GroundOptions {
  GroundMethod method = GroundMethod::kHeight;
  double sensor_height = 1.73;  ///< m, LiDAR above the road; KITTI's
  double tolerance = 0.25;      ///< m, points up to this above the plane are ground
  int ransac_iterations = 200;
  double ransac_max_tilt = 10;  ///< degrees between the plane's normal and the LiDAR's z axis
  std::uint64_t seed = 1;
};

/// Mask, 1 for ground, of points in the LiDAR frame (m, relative to the LiDAR). RANSAC falls back
/// to the height threshold if no plane within ransac_max_tilt is found.
FOVEA_API std::vector<std::uint8_t> segment_ground(std::span<const Eigen::Vector3f> points_lidar,
                                                   const GroundOptions& options);

/// Height of the LiDAR above the plane below it with the most points (m): 0.3 to 4.5 m, tilted
/// by at most 25 degrees. Empty if no such plane is in view.
FOVEA_API std::optional<double> sensor_height(std::span<const Eigen::Vector3f> points_lidar);

}  // namespace fovea
