// A coarse picture of a tile of a city, in a file next to the tile's map: a viewer shows the whole
// city from these files alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fovea/map/point_files/point_stream.h"

namespace fovea {

/// Exposure of the colors of a city where the user chooses none: `auto` would differ from tile to
/// tile.
inline constexpr ExposureChoice kCityExposure{ExposureChoice::Kind::kMap, 0, 0};

/// The exposure of all tiles for a user's choice. ConfigError for that of a frame: each tile
/// numbers its frames by itself.
ExposureChoice exposure_of_city(const ExposureChoice& chosen);

/// Grid that thins an overview, m.
inline double overview_spacing(double tile_size) { return tile_size / 128; }

/// The points of a tile's map, thinned to one in each cell of a grid. In the map's frame.
/// @param map      outlives the call only
/// @param spacing  of the grid, m
/// @throws InputError  if the map is damaged
std::vector<ExportPoint> overview_points(const MapReader& map, double spacing,
                                         const ExposureChoice& exposure);

/// The overview of a map as binary glTF (make_glb). Its levels of detail are for the coarse
/// pictures of a whole city: each has a grid of twice the spacing of the level below.
/// @throws InputError  if the map is damaged
std::string make_overview(const std::filesystem::path& map, double tile_size,
                          const ExposureChoice& exposure);

/// Writes make_overview() to a file, in one step, over an older one.
/// @throws InputError as above, OutputError if it cannot be written
void write_tile_overview(const std::filesystem::path& map, const std::filesystem::path& overview,
                         double tile_size);

}  // namespace fovea
