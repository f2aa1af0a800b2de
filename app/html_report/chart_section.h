// The charts of a page: where, when and how much the map errs, and how long mapping took.
#pragma once

#include <string>

#include "fovea/drive/frame_source.h"
#include "fovea/evaluation/report.h"
#include "fovea/evaluation/scored_map.h"

namespace fovea::app {

/// What a map of another program does not tell (latency) is left out with a sentence.
std::string chart_section(const ScoredMap& map, const DriveInfo& drive,
                          const EvaluationReport& report);

/// Time of the stages of each frame in a box; a sentence where the map does not tell.
std::string latency_panel(const ScoredMap& map, const DriveInfo& drive);

}  // namespace fovea::app
