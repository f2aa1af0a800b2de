// The four charts of the paper, with our figures and with those of the paper.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/paper/results_page.h"

namespace fovea::paper {

/// The row of a drive; null if it has none of this name.
const nlohmann::ordered_json* find_row(const DriveResults& drive, const std::string& name);

/// Writes each chart to FIGURE-DRIVE.svg in the folder.
/// @return the Markdown that shows them
std::string write_charts(const std::vector<DriveResults>& drives,
                         const std::filesystem::path& folder);

}  // namespace fovea::paper
