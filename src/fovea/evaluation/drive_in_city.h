// Where a drive is in a city: the frames of its maps in the tiles.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fovea/city/city.h"
#include "fovea/drive/frame_source.h"
#include "fovea/map/frame_record.h"

namespace fovea {

struct DriveInCity {
  std::string name;  ///< of the drive in the city
  /// Each frame once, under its number in the drive, in the local frame of the city. A frame counts
  /// as mapped if any tile has it as mapped.
  std::vector<FrameRecord> frames;
  /// For each map of the drive, by CityFrames::map_id(): the numbers of the drive by those in the
  /// map.
  std::map<std::string, std::map<int, int>> numbers;
  std::vector<std::string> notes;  ///< comparisons that were impossible
};

/// Reads the frames of the tiles around the drive's navigation, or of all tiles without it. Two
/// drives are the same as in match_drive().
/// @param foreign  take the frames of the city's drive of the same name without a comparison
/// @throws InputError  if the drive lies outside of the city, if the city was not made of the
/// drive,
///                     or if a tile is damaged
DriveInCity find_drive_in_city(const City& city, const FrameSource& drive, bool foreign);

}  // namespace fovea
