// The tables and figures of the paper, from the given drives.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "tools/paper/mls_times.h"

namespace fovea::paper {

struct ReproduceJob {
  std::vector<std::unique_ptr<FrameSource>> drives;
  std::vector<std::string> names;  ///< of the drives, each different
  std::vector<std::string> rows;   ///< in the order of the tables, see reproduced_rows()
  std::filesystem::path output;    ///< folder; it is made if it does not exist
  std::string command;             ///< command line, for the head of the page
  std::optional<MlsTimes> mls;     ///< for Table I
  /// Called after each row of each drive.
  std::function<void(int done, int total, const std::string& row)> progress;
};

/// Names of drives for the page. A repeated name gets a number, since all simulated drives have the
/// same folder inside.
std::vector<std::string> drive_names(const std::vector<std::string>& drives);

/// Maps and scores each drive once for each row. Writes results.md, results.json, the charts and a
/// report page into the output folder.
/// @return the warnings of all maps, each once
/// @throws ConfigError  if the settings of any row are impossible
std::vector<std::string> reproduce(const ReproduceJob& job);

}  // namespace fovea::paper
