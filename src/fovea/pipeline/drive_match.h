// Whether a map was made of a drive: by stamps, scans and calibration, not by names.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

/// Smallest share of equal stamps. It counts within the common time of map and drive, of the one
/// that has fewer stamps there: a drive may be thinned, and a map may be of a part of it.
inline constexpr double kMinCommonStamps = 0.5;

/// Which frames of a map are frames of a drive.
struct DriveMatch {
  std::map<int, int> number_in_drive;  ///< by the number of the frame in the map
  /// Whether all frames of the map have their numbers in the drive.
  bool keeps_numbers = true;
  std::vector<int> drives;         ///< numbers of the map's drives that are this drive
  std::vector<std::string> notes;  ///< what could not be compared
};

/// Finds a drive among the drives of a map. It is the same drive if
/// - at least kMinCommonStamps of the stamps are equal, to the nanosecond,
/// - scans of common frames (three are read) have as many points as when they were mapped,
/// - each camera in use, and the place of the IMU, has the same fingerprint in both.
/// The map of a format without fingerprints is compared by stamps alone, and a note says so.
/// @param drive  under its own calibration, not a corrected one
/// @param path   of the map, for errors
/// @throws InputError  if the map was not made of the drive
DriveMatch match_drive(const MapReader& map, const FrameSource& drive,
                       const std::filesystem::path& path);

/// The drive with the numbers that its frames have in the map; it has no other frames then.
std::unique_ptr<FrameSource> with_map_numbers(std::unique_ptr<FrameSource> drive,
                                              const DriveMatch& match);

}  // namespace fovea
