// Figures for people and for programs (the contract of --report).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fovea/core/messages.h"
#include "fovea/core/output_file.h"
#include "fovea/pipeline/map_summary.h"

namespace fovea::app {

/// One message for each camera's calibration; a warning where edges lie over a pixel off.
Messages calibration_messages(const MapSummary& summary);

/// Writes indented JSON and commits the file.
void write_json(OutputFile& file, const nlohmann::ordered_json& json);

}  // namespace fovea::app
