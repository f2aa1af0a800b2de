// Colour rules on identical points under identical poses, scored by held-out frames
// (docs/method.md 7).
#pragma once

#include "fovea/evaluation/color_rules_report.h"
#include "fovea/evaluation/evaluate.h"

namespace fovea {

/// Gives every coloured point of a map the colours that each rule takes from the training frames,
/// and scores them by the held-out frames, in the order of kColorRules.
///
/// One pass over the training frames serves all rules; memory grows with the points (about 200
/// bytes each) and not with the frames. The scores do not depend on the number of threads. Frames
/// that the drive cannot load are passed over.
/// @param options  of the protocol held-out (ConfigError otherwise)
/// InputError if no point is seen by a training view or none of those can be scored, and as
/// evaluate().
std::vector<ColorRuleScore> compare_color_rules(const ScoredMap& map, const FrameSource& drive,
                                                const ProtocolOptions& options);

}  // namespace fovea
