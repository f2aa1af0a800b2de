// A map's surface as 3D Tiles with levels of detail.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fovea/exporting/mesh/mesh_levels.h"
#include "fovea/map/map_store.h"

namespace fovea {

struct MeshTilesetFigures : MeshFigures {
  std::size_t tiles = 0;
};

/// Writes a folder with a 3D Tiles 1.1 tileset of triangles: tileset.json and tiles/*.glb. A tile
/// is a block of a level; the voxels of each level are twice those of the one below it. The root's
/// transform takes the local frame to EPSG 4978 where the map is georeferenced. Memory does not
/// grow with the map but for some bytes a block. The folder appears when it is whole. OutputError
/// if it cannot be written, or exists and `force` is false or it is no tileset; InputError as
/// PointStream.
/// @param beside  files that lie beside the tileset: their bytes, by their place in the folder
MeshTilesetFigures write_mesh_tileset(const MapReader& map, const std::filesystem::path& path,
                                      const MeshOptions& options = {},
                                      const std::map<std::string, std::string>& beside = {});

}  // namespace fovea
