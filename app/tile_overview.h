// A tile of a city with its overview.
#pragma once

#include <filesystem>
#include <vector>

#include "fovea/merging/tile_fusion.h"

namespace fovea::app {

/// fuse_tile(), and writes the tile's overview (exporting/city/tile_overview.h) next to the map.
/// The map gets its name last, so that each map has its overview.
TileFusionFigures fuse_with_overview(const std::vector<std::filesystem::path>& maps,
                                     const CityPoses& city, TileFusionJob job);

}  // namespace fovea::app
