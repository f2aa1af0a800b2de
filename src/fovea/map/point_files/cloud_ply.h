// A single cloud as a PLY file.
#pragma once

#include <filesystem>

#include "fovea/point_cloud.h"

namespace fovea {

/// Writes a cloud as binary little endian PLY: x y z (float, m, its own frame, origin added),
/// intensity (float, where the cloud has it) and interpolated (uchar, likewise). The file appears
/// when it is whole; OutputError if it cannot be written or exists and `force` is false.
void write_cloud_ply(const PointCloud& cloud, const std::filesystem::path& path, bool force);

}  // namespace fovea
