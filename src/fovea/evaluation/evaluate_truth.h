// Scores a map against the truth of a simulated drive (docs/simulator.md).
#pragma once

#include "fovea/evaluation/scored_map.h"
#include "fovea/evaluation/truth_report.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

struct TruthOptions {
  /// Lay the map's trajectory over the true one before points are compared; otherwise the map stays
  /// where its georeference says (or, without one, as it is).
  bool align = true;
};

/// Every figure; the scored cameras are those that the drive was opened with. The report does not
/// depend on the number of threads. InputError if the drive has no truth or it is damaged, if it
/// knows none of the map's frames, or if the map has no coloured point.
TruthReport evaluate_truth(const ScoredMap& map, const FrameSource& drive,
                           const TruthOptions& options);

}  // namespace fovea
