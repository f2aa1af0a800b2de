// A map's points as 3D Tiles, which web globes stream.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fovea/exporting/tileset/tile_tree.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea {

struct TilesetOptions {
  PointChoice points = {};    ///< of local coordinates: the tileset's root says where these are
  bool with_sources = false;  ///< also where each point comes from (make_glb)
  TileTreeOptions tree = {};
  /// Files that lie beside the tileset: their bytes, by their place in the folder.
  std::map<std::string, std::string> beside = {};
  bool force = false;  ///< replace an existing tileset
};

struct TilesetFigures : ExportFigures {
  std::size_t tiles = 0;
};

/// Writes a folder with a 3D Tiles 1.1 tileset: tileset.json and tiles/*.glb. The leaves have every
/// point, to a third of a millimetre; the root's transform takes the local frame to EPSG 4978 where
/// the map is georeferenced. Memory as for_each_node(). The folder appears when it is whole.
/// OutputError if it cannot be written, or exists and `force` is false or it is no tileset;
/// InputError as PointStream and make_tile_tree().
TilesetFigures write_tileset(const MapReader& map, const std::filesystem::path& path,
                             const TilesetOptions& options = {});

}  // namespace fovea
