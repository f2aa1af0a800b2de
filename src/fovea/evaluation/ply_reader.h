// Coloured point clouds in PLY, ours and other programs'.
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "fovea/base/point_cloud.h"

namespace fovea {

struct PlyCloud {
  /// Columns position, color and camera; frame and interpolated where the file has them. Points are
  /// uncoloured (kNoCamera) where the file says so or has no colours; camera is 0 where it names
  /// none.
  PointCloud points;
  bool has_camera = false;
};

/// Reads the vertices of a PLY file (binary little endian or ascii): x y z of type float or double,
/// and optionally red green blue (uchar), camera, frame, interpolated; further properties, and
/// elements after the vertices, are passed over. InputError that names line or vertex for anything
/// else.
/// @param origin  that the points are made relative to
PlyCloud read_ply(const std::filesystem::path& file, const Eigen::Vector3d& origin);

}  // namespace fovea
