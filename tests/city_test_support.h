// Small cities for tests of the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fovea/geometry/city_grid.h"

namespace fovea {

/// Writes a poses file that has the maps where their georeferences have them, as `adjust`
/// does without matches.
void adjust_alone(const std::vector<std::filesystem::path>& maps,
                  const std::filesystem::path& poses);

/// Makes the folder of a city: fuses the tiles from `low` to `high` that have points, and writes
/// the manifest. Its drives have the names of the maps' files.
/// @return the number of tiles with points
std::size_t make_city(const std::filesystem::path& city,
                      const std::vector<std::filesystem::path>& maps,
                      const std::filesystem::path& poses, const CityTile& low, const CityTile& high,
                      double tile_size = 64);

/// Writes city.json of the tiles CITY/tiles/X_Y.fovea and the poses CITY/poses.json.
void write_manifest(const std::filesystem::path& city, const std::vector<std::string>& drives,
                    double tile_size);

}  // namespace fovea
