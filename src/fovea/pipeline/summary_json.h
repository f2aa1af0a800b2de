// Figures of a run as JSON, for reports and other languages.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fovea/drive/live/live_source.h"
#include "fovea/pipeline/map_summary.h"

namespace fovea {

/// A stage's "p50", "p95" and "max", ms.
nlohmann::ordered_json to_json(const StageLatency& latency);

/// Counts of a live source.
nlohmann::ordered_json to_json(const LiveFigures& figures);

/// The "map" object of a report.
nlohmann::ordered_json to_json(const MapSummary& summary);

}  // namespace fovea
