// A city as 3D Tiles: a tileset for each tile, and the root above them.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fovea/city/city.h"

namespace fovea {

/// Folder of a tile's part in the folder of a city's export: "X_Y".
std::string city_part_name(const CityTile& tile);

struct CityRootOptions {
  bool with_sources = false;  ///< also where each point comes from (make_glb)
  /// Files that lie next to the tileset: their bytes, by their place in the folder.
  std::map<std::string, std::string> beside = {};
  bool force = false;  ///< replace an existing root
};

struct CityRootFigures {
  std::size_t nodes = 0;  ///< above the tiles
};

/// Writes the root of a city above the parts of its tiles: FOLDER/tileset.json on earth, and
/// FOLDER/q/HASH with the levels above the tiles. HASH is that of the levels, and tileset.json
/// comes last: a program that is killed leaves the earlier root or the new one. The parts are
/// folders of write_tileset(): FOLDER/X_Y, or the name of the tile's map without its ending, by
/// which jobs find parts of this revision. Only their coarsest levels are read, and the points of
/// one path of the quadtree are in memory.
/// @throws InputError   if a part is missing or damaged
/// @throws OutputError  if the root exists and `force` is false, or if it cannot be written
CityRootFigures write_city_root(const City& city, const std::filesystem::path& folder,
                                const CityRootOptions& options = {});

}  // namespace fovea
