// What an evaluation scores, before any frame is read: the same for figures and for pictures.
#pragma once

#include <utility>
#include <vector>

#include "fovea/evaluation/scorer.h"

namespace fovea {

struct EvaluationSetup {
  std::vector<PlacedFrame> frames;  ///< to score, by increasing index
  /// First and last index of each block of held-out frames; empty where none follow each other.
  std::vector<std::pair<int, int>> blocks;
  ScorerOptions scoring;
};

/// InputError if the map has no coloured point, or as select_frames() and select_cameras().
EvaluationSetup prepare_evaluation(const ScoredMap& map, const FrameSource& drive,
                                   const ProtocolOptions& options);

}  // namespace fovea
