// A map as transforms.json, which nerfstudio and instant-ngp read.
#pragma once

#include "fovea/exporting/views/view_export.h"

namespace fovea {

/// Writes the folder PATH:
/// - transforms.json: pinhole cameras, poses camera to world in the axes of OpenGL (x right, y up,
///   z backward), and lists of the images to train and to test if frames are held out
/// - points.ply: the points
/// - images/: the images, with `options.drive`
/// - masks/: what the images show of the scene, if the drive has masks
/// OutputError if the folder exists and `options.force` is false, or if it cannot be written.
/// @param map_path  of the map, for errors
/// @throws InputError  as gather_views()
ViewExportFigures write_nerf(const MapReader& map, const std::filesystem::path& map_path,
                             const std::filesystem::path& path, const ViewExportOptions& options);

}  // namespace fovea
