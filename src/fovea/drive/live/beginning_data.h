// What the beginning of a live drive waits for, and what it has then.
#pragma once

#include <string>
#include <vector>

#include "fovea/drive/live/frame_queue.h"
#include "fovea/drive/live/live_beginning.h"
#include "fovea/drive/live/live_motion.h"
#include "fovea/drive/live/live_source.h"

namespace fovea {

/// "images of camera front"; empty if nothing is missing.
std::vector<std::string> missing_data(const FrameQueue& queue, const LiveMotion& motion,
                                      const DriveDescription& description,
                                      const LiveOptions& options);

/// The data at hand.
/// @param scans  at most, of the first LiDAR
FirstData first_data(const FrameQueue& queue, const DriveDescription& description,
                     std::size_t scans);

/// By number of the sensor (LiveSensors).
struct SensorUse {
  std::vector<bool> is_used;
  /// Whether it would be used if it had sent data, and is not used later.
  std::vector<bool> is_wanted;
};

/// @param by_poses  whether navigation has poses, not positions
SensorUse find_use(const DriveDescription& description, const DriveOptions& options,
                   const LiveBeginning& beginning, bool by_poses);

}  // namespace fovea
