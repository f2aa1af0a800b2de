// A map's points as a PLY file, which nearly every point-cloud program reads.
#pragma once

#include <filesystem>

#include "fovea/map/point_files/point_file_options.h"

namespace fovea {

/// Writes the map's points, tile by tile, as binary little endian PLY: x y z (m), red green blue
/// (uchar), camera (char), frame (int), range (float, m), interpolated, views, spread, reason
/// (uchar), intensity (float, 0-1) if the map has it; comments tell the coordinates. The file
/// appears when it is whole. OutputError if it cannot be written or exists and `force` is false;
/// InputError as PointStream.
ExportFigures write_ply(const MapReader& map, const std::filesystem::path& path,
                        const PointFileOptions& options = {});

}  // namespace fovea
