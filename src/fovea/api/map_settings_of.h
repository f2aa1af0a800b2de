// Private to api/.
#pragma once

#include "fovea/mapper.h"
#include "fovea/pipeline/map_settings.h"
#include "fovea/pipeline/map_summary.h"

namespace fovea {

/// @throws ConfigError  for a preset, a key or a value that there is not
MapSettings map_settings_of(const MapperSettings& settings);

/// @param json  of all figures
MapFigures map_figures(const MapSummary& summary, std::string json);

}  // namespace fovea
