// Views of a scan for drives without cameras: pinhole cameras at the LiDAR, without images.
#pragma once

#include <vector>

#include "fovea/camera.h"

namespace fovea {

/// Four views from a place in the LiDAR frame that cover all azimuths and elevations up to 45
/// degrees. Neighbors overlap, so that triangles across their borders exist. Their number is
/// kNoCamera: points stay without color.
std::vector<Camera> lidar_views(const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

}  // namespace fovea
