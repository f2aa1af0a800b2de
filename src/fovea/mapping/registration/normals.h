// Surface normals of an unorganised cloud.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace fovea {

/// Normal of each point: the direction of least variance among its k nearest points (itself
/// included).
///
/// @param points     N points (m) in the sensor's frame, the sensor at the origin
/// @param neighbors  k, at least 3
/// @param spacing    about which the points lie apart at least (m), as thinned ones do; 0 if some
///                   lie much closer than others, which takes several times as long
/// @return N unit normals towards the sensor; zero where fewer than three neighbours, or neighbours
/// on
///         one line, leave the plane undetermined
std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              int neighbors, double spacing = 0);

}  // namespace fovea
