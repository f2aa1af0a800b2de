// Scores a map against the truth of a simulated drive (docs/simulator.md).
#pragma once

#include "fovea/drive/frame_source.h"
#include "fovea/evaluation/scored_map.h"
#include "fovea/evaluation/truth_poses.h"
#include "fovea/evaluation/truth_report.h"

namespace fovea {

struct TruthOptions {
  /// Lay the map's trajectory over the true one before points are compared; otherwise the map stays
  /// where its georeference says (or, without one, as it is).
  bool align = true;
};

/// A report with what pictures of it need. Points are the map's coloured ones, in the truth's local
/// frame, laid over it as the report says.
struct TruthEvaluation {
  TruthReport report;
  PointCloud points_true;
  std::vector<float> distance;         ///< of each point to the nearest true surface (m)
  std::vector<std::uint8_t> is_ghost;  ///< 1 for points on things that moved; see find_ghosts
  std::vector<PosePair> poses;
  RigidMotion T_true_map = RigidMotion::Identity();
};

/// Every figure; the scored cameras are those that the drive was opened with. The report does not
/// depend on the number of threads. InputError if the drive has no truth or it is damaged, if it
/// knows none of the map's frames, or if the map has no coloured point.
/// @param map  move it here if its points are not used again
TruthEvaluation evaluate_truth_points(ScoredMap map, const FrameSource& drive,
                                      const TruthOptions& options);
/// The report alone.
TruthReport evaluate_truth(ScoredMap map, const FrameSource& drive, const TruthOptions& options);

}  // namespace fovea
