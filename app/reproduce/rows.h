// Runs rows of the paper's Table II on a drive and keeps what they measured.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <vector>

#include "fovea/sensor/frame_source.h"

namespace fovea::app {

/// Rows in the order of the tables: the paper's variants, then the presets.
std::vector<std::string> reproduced_rows();

/// Maps the drive as a row says, twice: all frames (scored in-sample, in both readings) and with
/// every eighth held out, and keeps the figures in FOLDER/ROW.json; what stands there already from
/// the same program version and configuration is taken as it is. Maps are removed again.
/// @return {"row", "config", "all": {"map", "in_sample", "in_sample_nav", "scan_matching"},
/// "held_out": {"map",
///         "held_out"}}; null if it was stopped
nlohmann::ordered_json run_row(const FrameSource& drive, const std::string& row,
                               const std::filesystem::path& folder, const std::stop_token& stop);

}  // namespace fovea::app
