// Coloured point clouds in PCD, the Point Cloud Library's format (version 0.7).
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "fovea/map/point_files/cloud_columns.h"

namespace fovea {

/// Reads a PCD file (ascii, binary or binary_compressed): x y z of type F; colours as rgb or rgba
/// (four bytes 0xAARRGGBB, of type U or I, or a float of these bits; in a text also a whole number)
/// or as r g b (0-255); optionally camera, frame, interpolated. Further fields are passed over.
///
/// Points with a coordinate that is not a number are left out: an organised cloud has them where
/// nothing was measured. VIEWPOINT says where the sensor stood and moves no point, as in the
/// library itself. InputError that names line, offset or point for anything else.
/// @param origin  that the points are made relative to
CloudFile read_pcd(const std::filesystem::path& file, const Eigen::Vector3d& origin);

}  // namespace fovea
