// Rewrites a map in the present format, without what is damaged.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fovea/map/map_store.h"

namespace fovea {

struct RepairFigures {
  std::size_t points = 0;
  std::size_t faults = 0;    ///< of the file's structure, which cost no row
  std::size_t left_out = 0;  ///< parts that could not be read
  /// Keys of the meta data that were lost: taken from other tables, or lost for good.
  std::vector<std::string> restored, lost;
};

/// Writes all rows of a map that are whole, of any format that MapReader reads, and commits. A map
/// whose rows are all whole keeps its digest. Otherwise the new map's key `repair` states how much
/// is lost, and meta data that other tables state, too, are restored. State for resuming is left
/// out. Memory: one tile. Errors as of reader and writer.
/// @param on_damage  takes a line about each: "damaged: ..." of the structure, "left out: ..." of a
///                   part that cannot be read
RepairFigures repair_map(const std::filesystem::path& map, MapWriter& output,
                         const std::function<void(const std::string&)>& on_damage);

}  // namespace fovea
