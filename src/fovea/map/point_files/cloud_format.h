// Which clouds of other programs can be scored, and their readers.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "fovea/map/point_files/cloud_columns.h"

namespace fovea {

enum class CloudFormat { kPly, kPcd, kLas, kLaz };

/// By the content, or by the ending in any case if the content is of no known format. Empty for a
/// map. InputError that names the format of any other file.
std::optional<CloudFormat> cloud_format(const std::filesystem::path& file);

/// Reads a coloured cloud, see read_ply, read_pcd and read_las. InputError if it is missing,
/// damaged, or compressed LAS.
/// @param origin  that the points are made relative to
CloudFile read_cloud(const std::filesystem::path& file, CloudFormat format,
                     const Eigen::Vector3d& origin);

}  // namespace fovea
