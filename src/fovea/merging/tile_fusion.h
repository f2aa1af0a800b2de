// Fuses the points of many maps in one tile of a city.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fovea/geometry/city_grid.h"
#include "fovea/map/map_store.h"
#include "fovea/merging/city_poses.h"

namespace fovea {

struct TileFusionJob {
  std::filesystem::path output;
  bool force = false;
  std::filesystem::path scratch;  ///< as MapJob::scratch
  bool allow_empty = false;       ///< a tile without points is a map without points, no error
  CityTile tile;
  double tile_size = 64;  ///< m
  /// Whose color a surface gets: "best" (the map with the most points that were seen well in this
  /// tile), "latest" (the last recording day), or a recording day, or the name of a drive. The
  /// others follow by "best".
  std::string session = "best";
  double spacing = 0.02;  ///< of the maps' points, m
};

struct TileFusionFigures {
  std::size_t maps = 0;    ///< with points in the tile
  std::size_t read = 0;    ///< points of all maps in the tile
  std::size_t parked = 0;  ///< left out: a later drive saw through them
  std::size_t known = 0;   ///< left out: another map shows the surface
  std::size_t points = 0;  ///< of the tile
};

/// Writes a map of one tile. Its local frame is east-north-up at the middle of the tile. Each
/// surface is there once, with the color of one drive; points keep the submap that they come from.
/// @param maps  in any order: the result does not depend on it
/// @throws InputError  if a map is damaged, is not in the poses, or if no map has a point in the
///                     tile
TileFusionFigures fuse_tile(const std::vector<std::filesystem::path>& maps, const CityPoses& city,
                            const TileFusionJob& job);

}  // namespace fovea
