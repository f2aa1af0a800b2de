// The files that make a tileset folder a web site with the viewer.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "fovea/map/map_store.h"

namespace fovea {

/// A file of the viewer's page, built into the program.
struct PageFile {
  std::string_view name;  ///< path in the site
  std::string_view bytes;
};

/// The page, map.json and frames.json, by their paths in the folder. With them, any web server
/// shows the tileset.
/// @param mesh  whether the tileset has triangles instead of points
/// @throws InputError  if the metadata of the map are damaged
std::map<std::string, std::string> viewer_files(const MapReader& map,
                                                std::span<const PageFile> page, bool mesh);

}  // namespace fovea
