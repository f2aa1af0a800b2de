// Surface normals of an unorganized cloud.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

struct NormalOptions {
  int neighbors = 10;  ///< k, at least 3: approximate number of points of a plane
  /// m, the least distance between points of a thinned cloud; 0: the cloud is not thinned. The
  /// search is several times as fast with a spacing.
  double spacing = 0;
  double range_noise = 0.02;  ///< m, standard deviation of a measured range; used with a spacing
};

/// Normal of each point: the direction of least variance among the points around it, itself
/// included.
///
/// Without a spacing, the plane is fitted to the k nearest points. With a spacing, it is fitted to
/// all points within the smallest radius of 2, 3, 4.5, ... 34 spacings that holds 0.6 k points and
/// determines the plane: range noise tilts the normal by less than 4 degrees. Points on a single
/// ring of a LiDAR lie nearly on one line, which leaves the tilt about this line open.
///
/// @param points  N points (m) in the sensor's frame, the sensor at the origin
/// @return N unit normals toward the sensor; zero where the plane is not determined
std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              const NormalOptions& options);

/// Normals of some points, fitted to all points.
/// @param of  indices of these points
/// @return one normal for each of `of`
std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              std::span<const std::uint32_t> of,
                                              const NormalOptions& options);

}  // namespace fovea
