// Whether poses of scored frames come from where those of mapped frames come from.
#pragma once

#include <limits>
#include <vector>

#include "fovea/evaluation/evaluated_set.h"
#include "fovea/map/frame_record.h"

namespace fovea {

/// How far poses of scored frames stray from the navigation against those of mapped ones: a pose
/// fitted to the held-out colours leaves the course that registration holds.
struct PoseStray {
  double scored = std::numeric_limits<double>::quiet_NaN();  ///< median, m
  double mapped = std::numeric_limits<double>::quiet_NaN();  ///< median, m
};
/// For each frame with both poses and with such a mapped frame on either side: the distance of its
/// correction (the refined pose's translation in the navigation's frame) to the mean of its two
/// neighbours', weighed by their nearness in frames.
PoseStray pose_stray(const std::vector<FrameRecord>& frames,
                     const std::vector<PlacedFrame>& scored);

}  // namespace fovea
