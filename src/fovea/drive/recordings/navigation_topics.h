// Poses and positions of a recording.
#pragma once

#include <string>
#include <vector>

#include "fovea/drive/recordings/bag_index.h"
#include "fovea/drive/recordings/convert_options.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// Fills in what the drive knows of its motion: poses or positions, and an IMU; and where LiDAR,
/// IMU and antenna sit on the body, whose frame is that of the poses, `base_link`, or the LiDAR's.
/// InputError for what the options name and the recording does not have, and for several topics
/// that might be meant.
/// @param notes  what was chosen, and what is left out
/// @return the topics of positions, orientations and poses that are used; tf is not among them
std::vector<std::string> plan_navigation(const BagIndex& index, const ConvertOptions& options,
                                         const std::string& lidar_frame, RecordedDrive& drive,
                                         std::vector<std::string>& notes);

}  // namespace fovea
