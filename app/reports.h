// Figures for people and for programs (the contract of --report).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fovea/base/output_file.h"
#include "fovea/pipeline/map_summary.h"

namespace fovea::app {

/// What to tell of the cameras' calibration, a line each; a warning where edges lie over a pixel
/// off.
std::vector<std::string> calibration_lines(const MapSummary& summary);

/// Writes indented JSON and commits the file.
void write_json(OutputFile& file, const nlohmann::ordered_json& json);

}  // namespace fovea::app
