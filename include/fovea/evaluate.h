// How good a map is, by photographs or by the truth of a simulation.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive.h"

namespace fovea {

struct EvaluationOptions {
  /// "held-out", "cross-camera", "in-sample", "in-sample-nav" or, of simulated drives, "truth"
  /// (docs/report.md).
  std::string protocol = "held-out";
  std::vector<int> cameras = {};  ///< numbers; empty: those that colored the map
  std::string hold_out = {};      ///< "8:4"; empty: as the map was made
  bool foreign = false;           ///< also a drive that the map was not made of
  int threads = 0;                ///< 0: all that the machine has
};

/// Figures of a map. Absent: the protocol does not give them.
struct Evaluation {
  std::optional<double> mapping_error;  ///< mean distance of scan points from the map, m
  std::optional<double> texture_error;  ///< mean difference of colors, gray values
  std::optional<double> coverage_5cm;   ///< share of scan points with a map point within 5 cm
  std::string json;                     ///< all figures (docs/report.md)
};

/// Scores a map against its drive.
/// @param progress  is called with the number of frames done and that of all; from any thread, one
///                  call at a time. What it throws ends the evaluation
/// @throws InputError  if nothing can be scored, or the drive is not the map's
FOVEA_API Evaluation
evaluate_map(const std::filesystem::path& map, const std::filesystem::path& drive,
             const EvaluationOptions& options = {},
             const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace fovea
