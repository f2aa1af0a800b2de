// Coloured point clouds in LAS, the surveyors' format (ASPRS, versions 1.2 to 1.4).
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "fovea/map/point_files/cloud_columns.h"

namespace fovea {

/// Reads the points of a LAS file of a point format with colours (2, 3, 5, 7, 8, 10). Coordinates
/// are scaled and offset as its header says and taken as metres of the local frame. Colours have 16
/// bits; where none of the file exceeds 255 they are taken for the 8 bits that many programs write
/// there. Points that are marked as withheld are left out. InputError that names the offset for
/// anything else, and for compressed files (LAZ).
/// @param origin  that the points are made relative to
CloudFile read_las(const std::filesystem::path& file, const Eigen::Vector3d& origin);

/// The error of a file in LAZ: what it is, and how to convert it.
[[noreturn]] void reject_laz(const std::filesystem::path& file);

}  // namespace fovea
