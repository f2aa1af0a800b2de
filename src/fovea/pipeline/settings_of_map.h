// The settings that a map was made with.
#pragma once

#include <string>

#include "fovea/map/map_store.h"
#include "fovea/pipeline/map_settings.h"

namespace fovea {

/// InputError if the map does not state them.
/// @param map  names the map in errors
MapSettings settings_of_map(const MapMeta& meta, const std::string& map);

}  // namespace fovea
