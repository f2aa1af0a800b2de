// The pose of a frame as it leaves a live run.
#pragma once

#include "fovea/live.h"
#include "fovea/pipeline/tracking_state.h"

namespace fovea {

inline LivePose live_pose(const FrameResult& frame) {
  LivePose pose{frame.index, frame.stamp.value_or(0), state_of(frame.tracking),
                frame.poses.T_local_lidar, std::nullopt};
  if (frame.tracking.registration) pose.covariance = frame.tracking.registration->covariance;
  return pose;
}

}  // namespace fovea
