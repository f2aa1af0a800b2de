// Surface normals of an unorganised cloud.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fovea/geometry/kd_tree.h"

namespace fovea {

/// Normal of each point: the direction of least variance among its k nearest points (itself
/// included).
///
/// @param points     N points (m) in the sensor's frame, the sensor at the origin
/// @param tree       of the same points
/// @param neighbors  k, at least 3
/// @return N unit normals towards the sensor; zero where fewer than three neighbours, or neighbours
/// on
///         one line, leave the plane undetermined
std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              const KdTree& tree, int neighbors);

}  // namespace fovea
