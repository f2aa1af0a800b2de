// Where the LiDAR was at a frame and how it moved, for whoever is not the mapper.
#pragma once

#include <optional>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

struct FrameMotion {
  RigidMotion T_local_lidar = RigidMotion::Identity();
  SweepMotion sweep;  ///< of the LiDAR
};

/// Of a frame that need not be mapped yet: by navigation, or else by the poses given, one a frame
/// of the drive's range or of its first frames. Nothing where neither says.
std::optional<FrameMotion> known_motion(const FrameSource& source,
                                        const std::vector<RigidMotion>& given_poses, int index);

/// Of a frame that was not skipped: its motion is that by which its sweep was compensated, or
/// else follows from the poses of it and the frame before, if that is known and was not skipped.
std::optional<FrameMotion> mapped_motion(const FrameRecord& record,
                                         const std::optional<FrameRecord>& before);

}  // namespace fovea
