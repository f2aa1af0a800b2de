// A map's surface as one glTF file, for game engines.
#pragma once

#include <filesystem>

#include "fovea/exporting/mesh/mesh_levels.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Writes a binary glTF 2.0 file with one level of detail: floats, a mesh a block, y up: the local
/// frame's x, z, -y. Memory does not grow with the map but for some bytes a block. The file appears
/// when it is whole. OutputError if it cannot be written, exists and `force` is false, or would
/// have more than the 4 GiB that a file can; InputError as PointStream.
MeshFigures write_mesh_file(const MapReader& map, const std::filesystem::path& path,
                            const MeshOptions& options = {});

}  // namespace fovea
