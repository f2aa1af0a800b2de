// Runs rows of the tables on a drive and keeps what they measured.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"

namespace fovea::paper {

/// Rows in the order of the tables: the paper's variants, the presets, the ablations.
std::vector<std::string> reproduced_rows();

/// ConfigError if a row's settings are not possible.
void check_row(const std::string& row);

/// Maps the drive as a row says, with every eighth frame held out and, but for ablations, with all
/// frames (scored in-sample, in both readings). Keeps the figures in FOLDER/ROW.json; what stands
/// there already from the same program version and configuration is taken as it is. Maps are
/// removed again.
/// @param page  where to write the page of the held-out evaluation (see report_page); empty:
/// nowhere
/// @return {"row", "config", "all": {"map", "in_sample", "in_sample_nav", "scan_matching"},
/// "held_out": {"map", "held_out", "truth" of simulated drives}}; null if the row uses navigation's
/// poses and the drive has none
nlohmann::ordered_json run_row(const FrameSource& drive, const std::string& row,
                               const std::filesystem::path& folder,
                               const std::filesystem::path& page);

}  // namespace fovea::paper
