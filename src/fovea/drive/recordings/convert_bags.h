// Recordings of ROS as a folder with a drive.toml (docs/drives.md), without ROS.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/recordings/convert_options.h"
#include "fovea/time.h"

namespace fovea {

/// Its notes say what was chosen, what is left out and why.
struct ConvertFigures : Messages {
  std::size_t scans = 0;   ///< of all LiDARs
  std::size_t images = 0;  ///< of all cameras
  std::size_t cameras = 0, lidars = 0;
};

/// Reads the recordings, which belong together, twice: what calibration and poses they have, and
/// then, where all is there, the scans and images. Numbers are kept to the last digit; compressed
/// images are written as they are. Memory does not grow with scans and images.
/// InputError for recordings that cannot be read or are no drive; OutputError as
/// GenericDriveWriter. Nothing is kept of what was not finished.
/// @param bags      files or folders, as bag_files()
/// @param progress  called with messages done and in all
ConvertFigures convert_bags(const std::vector<std::filesystem::path>& bags,
                            const std::filesystem::path& output, bool force,
                            const ConvertOptions& options,
                            const std::function<void(int, int)>& progress);

/// What recordings contain. Its warnings name messages that cannot be used, and files that end
/// early.
struct RecordingContents : Messages {
  struct Topic {
    std::string name, type;
    std::size_t messages = 0;
    std::string frame;                  ///< of scans and images
    std::optional<TimeNs> first, last;  ///< stamps of scans and images
  };
  std::vector<Topic> topics;  ///< by name
};

/// InputError for recordings that cannot be read.
RecordingContents list_bags(const std::vector<std::filesystem::path>& bags);

}  // namespace fovea
