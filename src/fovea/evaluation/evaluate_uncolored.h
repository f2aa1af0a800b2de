// Scores maps without colors: by positions alone.
#pragma once

#include "fovea/evaluation/evaluate.h"

namespace fovea {

/// Whether a camera has colored a point of the map.
bool has_colors(const ScoredMap& map);

/// Figures of positions, see evaluate(). The evaluated set is every scan point at 3 to 15 m, in all
/// directions. Figures of colors and pictures are absent (NaN). InputError as evaluate(), and for
/// the protocol cross-camera.
EvaluationReport evaluate_uncolored(ScoredMap map, const FrameSource& drive,
                                    const ProtocolOptions& options,
                                    const EvaluationProgress& progress = {});

/// The table of such a report.
std::string uncolored_text(const EvaluationReport& report);

}  // namespace fovea
