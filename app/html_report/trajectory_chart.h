// The drive from above.
#pragma once

#include <string>
#include <vector>

#include "fovea/evaluation/report.h"
#include "fovea/map/frame_record.h"

namespace fovea::app {

/// The refined poses as a line, the navigation's dashed, the scored frames as marks in the class of
/// their mean TE (over cameras), to scale, y upwards. Empty for fewer than two frames.
/// @param north_up  whether the local frame is east-north-up, to be said in the picture
std::string trajectory_chart(const std::vector<FrameRecord>& frames, const EvaluationReport& report,
                             bool north_up);

}  // namespace fovea::app
