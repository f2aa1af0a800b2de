// Whether a map is of a drive, by stamps, scans and calibration, not by names.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Least share of equal stamps in the common time of map and drive, relative to the smaller number
/// of stamps there. A drive may be thinned, and a map may be of a part of it.
inline constexpr double kMinCommonStamps = 0.5;

/// The frames of a map that are frames of a drive.
struct DriveMatch {
  std::map<int, int> number_in_drive;  ///< by the number of the frame in the map
  /// Whether all frames of the map have the same numbers in the drive.
  bool keeps_numbers = true;
  std::vector<int> drives;         ///< numbers of the map's drives that are this drive
  std::vector<std::string> notes;  ///< comparisons that were impossible
};

/// Finds a drive among the drives of a map. Two drives are the same if
/// - at least kMinCommonStamps of the stamps are equal, to the nanosecond,
/// - the scans of three common frames have the same numbers of points. They may differ by over 10 %
/// if the motions by navigation agree, since rings may have been removed,
/// - each camera in use, and the position of the IMU, has the same fingerprint.
/// A map whose format has no fingerprints is compared only by stamps; a note states that.
/// @param drive  with its own calibration, not a corrected one
/// @param path   of the map, for errors
/// @throws InputError  if the map is not of the drive
DriveMatch match_drive(const MapReader& map, const FrameSource& drive,
                       const std::filesystem::path& path);

/// Compares the numbers of points of up to three scans, since different drives may have the same
/// regular stamps. Returns the difference; empty if half of them agree or none is readable.
/// @param number_in_drive  by the number of the frame in the map
/// @param allow_thinned    whether rings may have been removed (see match_drive())
std::optional<std::string> scan_difference(const std::vector<FrameRecord>& frames,
                                           const std::map<int, int>& number_in_drive,
                                           const FrameSource& drive, bool allow_thinned);

/// The drive with the frame numbers of the map, without frames that are not in the map.
std::unique_ptr<FrameSource> with_map_numbers(std::unique_ptr<FrameSource> drive,
                                              const DriveMatch& match);

}  // namespace fovea
