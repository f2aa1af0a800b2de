// Opening of a map whose rows are checked first.
#pragma once

#include <filesystem>

#include "fovea/map/map_store.h"

namespace fovea {

/// Opens a map. InputError if its structure or any row but those of tiles is damaged; tiles are
/// checked when they are read. So all commands accept and refuse the same maps.
MapReader open_checked_map(const std::filesystem::path& map);

}  // namespace fovea
