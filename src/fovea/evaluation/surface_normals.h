// Normals of a map's surface, from its points alone: any cloud can be asked for them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// Direction of least spread of the points in the 30-cm cube around each point's 10-cm voxel: unit,
/// of either sign, the same for all points of a voxel; zero where these points are too few or lie
/// as on a line or in a heap.
std::vector<Eigen::Vector3f> surface_normals(const std::vector<Eigen::Vector3f>& position);

}  // namespace fovea
