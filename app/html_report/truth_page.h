// The page of `fovea evaluate --truth --html`: one file that needs no network.
#pragma once

#include <string>

#include "fovea/evaluation/evaluate_truth.h"

namespace fovea::app {

struct TruthPageInput {
  const ScoredMap& map;
  const FrameSource& drive;           ///< whose truth scored the map
  const TruthEvaluation& evaluation;  ///< of this map and drive
  std::string map_name, drive_name;   ///< as people call them
};

/// The whole page, well-formed as XML; the same bytes for the same input at any number of threads.
/// InputError where a file of the truth is damaged.
std::string truth_page(const TruthPageInput& input);

}  // namespace fovea::app
