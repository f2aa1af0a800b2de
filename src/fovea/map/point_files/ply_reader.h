// Coloured point clouds in PLY, ours and other programs'.
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "fovea/map/point_files/cloud_columns.h"

namespace fovea {

/// Reads the vertices of a PLY file (binary little endian or ascii): x y z of type float or double,
/// and optionally red green blue (uchar), camera, frame, interpolated; further properties, and
/// elements after the vertices, are passed over. InputError that names line or point for anything
/// else.
/// @param origin  that the points are made relative to
CloudFile read_ply(const std::filesystem::path& file, const Eigen::Vector3d& origin);

}  // namespace fovea
