// The scans of a LiDAR of a drive with a drive.toml: files, stamps, format.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/core/read_file.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/drive_files.h"
#include "fovea/drive/first_scans.h"
#include "fovea/drive/nearest_images.h"
#include "fovea/drive/time_stamps.h"

namespace fovea {

/// The files of the LiDAR's folder. InputError for a number that is too large.
NumberedFiles list_scans(const std::filesystem::path& drive, const LidarDescription& lidar);

/// Stamps of scans by their number; none without a table. Warns of those out of order.
TimeStamps read_stamps_of_scans(const std::filesystem::path& table, const NumberedFiles& scans,
                                Messages& messages);

/// Scans whose numbers show the units.
inline constexpr int kFirstScans = 5;

/// Units of scans and timing of their sweeps.
struct ScanReading {
  ScanFormat format;
  SweepTiming sweep;
  bool has_times = false;   ///< whether the points have times
  double sweep_middle = 0;  ///< s from the stamp, by the times of the points if they have any
};

/// What the first scans of a LiDAR show.
struct FirstScans {
  std::vector<ScanNumbers> numbers;
  /// sweep_middle() of the first scan in its units.
  std::function<std::optional<double>(const ScanFormat&)> middle;
};

/// By drive.toml and the first scans. Notes and warns of what is assumed.
/// @param toml        the file, for messages
/// @param stamp_step  s, between the scans; absent if it cannot be the period of a sweep
ScanReading recognize_scans(const std::filesystem::path& toml, const LidarDescription& lidar,
                            const FirstScans& first, std::optional<double> stamp_step,
                            Messages& messages);

/// The same of files.
ScanReading recognize_scans(const std::filesystem::path& drive, const LidarDescription& lidar,
                            const NumberedFiles& scans, const StampOfScan& stamp,
                            std::optional<double> stamp_step, Messages& messages);

/// Gives each frame the scan of a further LiDAR whose sweep is nearest in time, at most half a
/// sweep away. Without stamps, scans and frames of one number belong together.
/// Warns of frames without a scan. InputError if no frame has one.
/// @param frame_numbers  of all frames
/// @param frames         stamps of those that have one; empty: the drive has none
/// @param sweep_middle   of the first LiDAR, s from its stamp
FurtherLidar find_further_lidar(const std::filesystem::path& drive, const LidarDescription& lidar,
                                const std::vector<int>& frame_numbers, const NumberedTimes& frames,
                                double sweep_middle, Messages& messages);

}  // namespace fovea
