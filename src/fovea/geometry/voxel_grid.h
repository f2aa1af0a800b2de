// Density control: at most one point a cubic voxel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// Indices of one point in each occupied voxel of edge `size` (m): the point nearest to the mean of
/// the voxel's points, so that measured points stay measured points. Increasing order; the same for
/// the same input.
std::vector<std::uint32_t> voxel_sample(std::span<const Eigen::Vector3f> points, float size);

/// The points that voxel_sample chooses; all of them for size 0.
std::vector<Eigen::Vector3f> voxel_thinned(std::vector<Eigen::Vector3f> points, float size);

}  // namespace fovea
