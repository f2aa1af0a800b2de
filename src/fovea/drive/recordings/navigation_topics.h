// Poses and positions of a recording.
#pragma once

#include <string>
#include <vector>

#include "fovea/drive/recordings/bag_index.h"
#include "fovea/drive/recordings/convert_options.h"
#include "fovea/drive/recordings/motion_messages.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// Topics and frames of tf that the motion comes from; empty: not used.
struct NavigationPlan {
  std::string fix, imu, odometry;  ///< topics
  ImuUse imu_use;
  std::string world, body;  ///< frames, if poses come from tf: T_world_body
};

/// Fills in what the drive knows of its motion: poses or positions, and an IMU; and where LiDAR,
/// IMU and antenna sit on the body, whose frame is that of the poses, `base_link`, or the LiDAR's.
/// InputError for what the options name and the recording does not have, and for several topics
/// that might be meant.
/// @param notes  what was chosen, and what is left out
NavigationPlan plan_navigation(const BagIndex& index, const ConvertOptions& options,
                               const std::string& lidar_frame, RecordedDrive& drive,
                               std::vector<std::string>& notes);

}  // namespace fovea
