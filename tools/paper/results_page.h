// The page that `fovea reproduce` writes: the paper's tables and figures, ours beside theirs.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/paper/mls_times.h"
#include "tools/paper/upsampling_times.h"

namespace fovea::paper {

struct DriveResults {
  std::string name;  ///< of the drive's folder
  std::vector<int> cameras;
  int frames = 0;
  std::vector<nlohmann::ordered_json> rows;  ///< see run_row
  std::vector<UpsamplingTime> upsampling;
};

/// Name of the file beside the page that shows the default row's held-out evaluation in pictures.
std::string report_file(const std::string& drive);

/// Warnings of all maps, each once.
std::vector<std::string> results_warnings(const std::vector<DriveResults>& drives);

/// Everything as JSON.
nlohmann::ordered_json results_json(const std::vector<DriveResults>& drives);

/// The page in Markdown. Its charts are written beside it, into `folder`: FIGURE-DRIVE.svg;
/// the drives' report files are linked where they are there.
/// @param mls      for Table I, where it was measured
/// @param command  what was typed, to stand at the top
std::string write_results_page(const std::vector<DriveResults>& drives,
                               const std::optional<MlsTimes>& mls, const std::string& command,
                               const std::filesystem::path& folder);

}  // namespace fovea::paper
