// Scores a map against a drive: every figure of docs/method.md 7, always together.
#pragma once

#include <functional>

#include "fovea/evaluation/report.h"

namespace fovea {

/// Called after each frame with the number done and that of all; from any thread, one call at a
/// time. What it throws ends the evaluation.
using EvaluationProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Frames are scored in parallel; the report does not depend on the number of threads. Frames that
/// the drive cannot load are skipped and listed. A map without colors is scored by positions alone
/// (evaluate_uncolored). InputError if nothing can be scored (no map point, no frame, no evaluated
/// point) or the protocol does not fit the map (see
/// select_frames); ConfigError for a camera that the drive was not opened with.
/// @param map  move it here if it is not used again: a second copy of its points takes memory
EvaluationReport evaluate(ScoredMap map, const FrameSource& drive, const ProtocolOptions& options,
                          const EvaluationProgress& progress = {});

}  // namespace fovea
