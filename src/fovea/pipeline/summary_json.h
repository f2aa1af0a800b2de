// A run's figures as JSON, for reports and for other languages.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fovea/pipeline/map_summary.h"

namespace fovea {

/// The "map" object of a report.
nlohmann::ordered_json to_json(const MapSummary& summary);

}  // namespace fovea
