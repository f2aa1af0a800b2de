// A map as a model of COLMAP, which trainers of Gaussian splatting read.
#pragma once

#include "fovea/exporting/views/view_export.h"

namespace fovea {

/// Writes the folder PATH:
/// - sparse/0/cameras.txt: cameras of the model PINHOLE
/// - sparse/0/images.txt: images with poses, without feature points
/// - sparse/0/points3D.txt: points without tracks
/// - sparse/0/test.txt: the names of held-out images, if there are any
/// - images/: the images, with `options.drive`
/// OutputError if the folder exists and `options.force` is false, or if it cannot be written.
/// @param map_path  of the map, for errors
/// @throws InputError  as gather_views()
ViewExportFigures write_colmap(const MapReader& map, const std::filesystem::path& map_path,
                               const std::filesystem::path& path, const ViewExportOptions& options);

}  // namespace fovea
