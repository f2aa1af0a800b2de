// What of a recording becomes what of a drive.
#pragma once

#include <string>
#include <vector>

#include "fovea/drive/recordings/bag_index.h"
#include "fovea/drive/recordings/camera_topics.h"
#include "fovea/drive/recordings/convert_options.h"
#include "fovea/drive/recordings/lidar_topics.h"
#include "fovea/drive/recordings/navigation_topics.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

struct ConversionPlan {
  std::vector<PlannedLidar> lidars;  ///< at least one
  std::vector<PlannedCamera> cameras;
  RecordedDrive drive;
  NavigationPlan navigation;
  std::vector<std::string> notes;  ///< what was chosen, what is left out and why
};

/// InputError for a recording that is no drive: without scans or cameras, without their calibration
/// or place, of sensors that different clocks have stamped, or of what may be meant in several
/// ways.
ConversionPlan plan_conversion(const BagIndex& index, const ConvertOptions& options);

}  // namespace fovea
