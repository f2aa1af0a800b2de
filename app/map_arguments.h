// What commands that make a map of maps need to know of them.
#pragma once

#include <string>

#include "fovea/map/map_store.h"
#include "fovea/pipeline/mapper_options.h"

namespace fovea::app {

/// The settings that a map was made with; InputError if it does not tell them.
MapperOptions stored_options(const MapMeta& meta, const std::string& map);

}  // namespace fovea::app
