// A map's points as 3D Tiles, which web globes stream.
#pragma once

#include <filesystem>

#include "fovea/exporting/point_stream.h"
#include "fovea/exporting/tileset/octree_builder.h"

namespace fovea {

struct TilesetOptions {
  PointChoice points = {};  ///< of local coordinates: the tileset's root says where these are
  OctreeOptions octree = {};
  std::size_t sort_points = 8'000'000;  ///< in memory at a time, 16 bytes each
  bool force = false;                   ///< replace an existing tileset
};

struct TilesetFigures : ExportFigures {
  std::size_t tiles = 0;
};

/// Writes a folder with a 3D Tiles 1.1 tileset: tileset.json and tiles/*.glb. Tiles replace their
/// parents; a tile's geometric error is the spacing that its points were thinned to, and the leaves
/// have every point, to 0.25 mm. The root's transform takes the local frame to EPSG 4978 where the
/// map is georeferenced. Works out of core: memory does not grow with the map. The folder appears
/// when it is whole. OutputError if it cannot be written, or exists and `force` is false or it is
/// no tileset; InputError as PointStream, or if the map spans over 1000 km.
TilesetFigures write_tileset(const MapReader& map, const std::filesystem::path& path,
                             const TilesetOptions& options = {});

}  // namespace fovea
