// Which topics of a recording are its LiDARs.
#pragma once

#include <string>
#include <vector>

#include "fovea/drive/recordings/bag_index.h"
#include "fovea/drive/recordings/convert_options.h"
#include "fovea/drive/scans/scan_format.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

struct PlannedLidar {
  std::string topic;
  ScanFormat format;
  RecordedLidar lidar;  ///< without a name if it is the only one
};

/// The LiDARs that the options name, or the only one. The frame of the first one is that of the
/// drive.
/// InputError if there are several to choose from, if tf does not say where one is, or if scans
/// have units without meaning. ConfigError for a topic that is named twice.
std::vector<PlannedLidar> plan_lidars(const BagIndex& index, const ConvertOptions& options,
                                      std::vector<std::string>& notes);

}  // namespace fovea
