// A map's points as a PCD file, the Point Cloud Library's format.
#pragma once

#include <filesystem>

#include "fovea/map/point_files/point_file_options.h"

namespace fovea {

/// Writes the map's points, tile by tile, as binary PCD 0.7: x y z (m), rgb (0x00RRGGBB in the bits
/// of a float, as PCL has it), camera (I 1), frame (I 4), range (F 4), interpolated, views, spread,
/// reason (U 1), intensity (F 4) if the map has it. Doubles are F 8. The file appears when it is
/// whole; errors as write_ply().
ExportFigures write_pcd(const MapReader& map, const std::filesystem::path& path,
                        const PointFileOptions& options = {});

}  // namespace fovea
