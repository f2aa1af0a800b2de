// The page of `fovea evaluate --html`: one file that needs no network.
#pragma once

#include <string>

#include "fovea/evaluation/scorer.h"

namespace fovea::app {

struct PageInput {
  const ScoredMap& map;
  const FrameSource& drive;
  const ProtocolOptions& options;  ///< that `report` was made with
  const EvaluationReport& report;
  std::string map_name, drive_name;  ///< as people call them
};

/// The whole page, well-formed as XML; the same bytes for the same input at any number of threads.
/// What the map or the drive cannot show (latency and navigation of other programs' clouds, frames
/// that cannot be loaded) is left out, and the page says so.
std::string report_page(const PageInput& input);

}  // namespace fovea::app
