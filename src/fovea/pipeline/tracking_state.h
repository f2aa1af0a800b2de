// The state of tracking as one word, for robots and reports.
#pragma once

#include "fovea/pipeline/frame_result.h"

namespace fovea {

/// "tracked", "lost" or "restarted".
inline const char* state_of(const TrackingStats& tracking) {
  if (tracking.is_lost) return "lost";
  return tracking.has_restarted || tracking.is_pose_unknown ? "restarted" : "tracked";
}

}  // namespace fovea
