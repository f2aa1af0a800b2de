#include "fovea/evaluation/evaluation_setup.h"

#include <algorithm>

#include "fovea/errors.h"
#include "fovea/evaluation/evaluate_uncolored.h"

namespace fovea {
namespace {

void require_coloured(const ScoredMap& map) {
  map.points_local.check();
  if (has_colors(map)) return;
  throw InputError("the map has no coloured point", "evaluation",
                   "score a map whose points have colours");
}

/// What the protocol and the drive's files ask of the scorer.
ScorerOptions scorer_options(const ScoredMap& map, const FrameSource& drive,
                             const ProtocolOptions& options, bool blocks) {
  ScorerOptions scoring;
  scoring.cameras = select_cameras(map, drive.info(), options);
  if (const auto file = find_tracklets(drive.info().path)) {
    scoring.moving.emplace(read_tracklets(*file), map.frames);
  }
  if (blocks) {
    std::vector<Camera> colouring;
    for (const Camera& camera : drive.info().calibration.cameras) {
      if (std::find(map.cameras.begin(), map.cameras.end(), camera.index) != map.cameras.end()) {
        colouring.push_back(camera);
      }
    }
    scoring.reach.emplace(map.frames, colouring);
  }
  return scoring;
}

}  // namespace

EvaluationSetup prepare_evaluation(const ScoredMap& map, const FrameSource& drive,
                                   const ProtocolOptions& options) {
  require_coloured(map);
  EvaluationSetup setup;
  setup.frames = select_frames(map, drive, options);
  if (scores_held_out(options.protocol)) setup.blocks = scored_blocks(setup.frames, map.frames);
  if (setup.blocks.size() == setup.frames.size()) setup.blocks.clear();
  setup.scoring = scorer_options(map, drive, options, !setup.blocks.empty());
  return setup;
}

}  // namespace fovea
