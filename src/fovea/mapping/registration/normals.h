// Surface normals of an unorganised cloud.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace fovea {

/// Normal of each point: the direction of least variance among the points around it, itself
/// included.
///
/// @param points     N points (m) in the sensor's frame, the sensor at the origin
/// @param neighbors  k, at least 3: how many points around it, about
/// @param spacing    about which the points lie apart at least (m), as thinned ones do; 0 if some
///                   lie much closer than others. Where it is known, all points count within the
///                   smallest of the radii of 2, 3, 4.5, ... 34 spacings that has 0.6 k points,
///                   else the k nearest, which takes several times as long
/// @return N unit normals towards the sensor; zero where there are not 0.6 k (three without a
/// spacing),
///         or where they lie on one line and leave the plane undetermined
std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              int neighbors, double spacing = 0);

/// Those of some points, among all.
/// @param of  indices of the points whose normals are wanted
/// @return one for each of `of`
std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              std::span<const std::uint32_t> of, int neighbors,
                                              double spacing);

}  // namespace fovea
