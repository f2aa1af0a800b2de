// What the first data of a live drive show: the same that open_drive() finds in a folder.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "fovea/drive/drive_description.h"
#include "fovea/drive/live/frame_queue.h"
#include "fovea/drive/live/live_decoder.h"

namespace fovea {

/// Camera numbers by place in drive.toml.
std::vector<int> camera_numbers(const DriveDescription& description);

/// By the places of the sensors in drive.toml.
struct FirstData {
  std::vector<std::shared_ptr<const LiveScan>> scans;  ///< of the first LiDAR; not empty
  std::vector<std::vector<std::shared_ptr<const LiveScan>>> further_scans;
  std::vector<std::vector<std::shared_ptr<const LiveImage>>> images;
};

struct LiveBeginning {
  DriveInfo info;  ///< without frames and motion
  LiveDecoder decoder;
  FrameQueue::Sensors sensors;
};

/// Units, timing, cameras and delays. Sensors without data are left out, with a warning.
/// @param name  of the drive, for messages
/// @throws ConfigError, InputError  as open_drive()
LiveBeginning find_sensors(const DriveDescription& description, const DriveOptions& options,
                           const std::filesystem::path& name, const FirstData& first);

}  // namespace fovea
