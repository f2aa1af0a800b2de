// Rewrites a map in the present format, without what is damaged.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "fovea/map/map_store.h"

namespace fovea {

struct RepairFigures {
  std::size_t points = 0;
  std::size_t damages = 0;  ///< parts that could not be read
};

/// Writes all rows of a map that are whole, of any format that MapReader reads, and commits. A map
/// without damage keeps its digest. Otherwise the new map's key `repair` states how much is lost,
/// and the size of the tiles and the origin are restored from other rows if `meta` has lost them.
/// State for resuming is left out. Memory: one tile. Errors as of reader and writer.
/// @param on_damage  takes a line about each part that cannot be read
RepairFigures repair_map(const std::filesystem::path& map, MapWriter& output,
                         const std::function<void(const std::string&)>& on_damage);

}  // namespace fovea
