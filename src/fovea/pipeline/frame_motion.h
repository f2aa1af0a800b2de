// Pose and motion of the LiDAR at a frame, outside the mapper.
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/map/frame_record.h"

namespace fovea {

struct FrameMotion {
  RigidMotion T_local_lidar = RigidMotion::Identity();
  SweepMotion sweep;  ///< of the LiDAR
};

/// Motion of a frame before it is mapped: by navigation, or else by given poses, one for each of
/// the drive's (first) frames. Empty without both.
std::optional<FrameMotion> known_motion(const FrameSource& source,
                                        const std::vector<RigidMotion>& given_poses, int index);

/// Motion of a mapped frame: that of its motion compensation, or else that from the pose of the
/// frame before. Empty if that frame is unknown or skipped.
std::optional<FrameMotion> mapped_motion(const FrameRecord& record,
                                         const std::optional<FrameRecord>& before);

}  // namespace fovea
