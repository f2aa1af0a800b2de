// What `fovea export` does with a city.
#pragma once

#include <string>

#include "app/export_map.h"

namespace fovea::app {

/// Writes a folder with a file or a tileset of each tile, and the root of these tilesets.
/// @throws ConfigError  if an option is not for cities
/// @throws InputError   if the manifest or a tile is damaged
void export_city(ExportArguments& arguments, const std::string& format, Warnings& warnings);

}  // namespace fovea::app
