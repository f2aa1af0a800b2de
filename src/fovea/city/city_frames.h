// The frames of the drives in the tiles of a city, in the frame of the city.
#pragma once

#include <string>
#include <vector>

#include "fovea/city/city.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// The frames of one map of a drive that a tile has.
struct CityFrames {
  DriveRecord drive;  ///< as the tile has it
  /// `index` is the number in the drive, T_local_lidar is in the local frame of the city, and no
  /// frame has a submap.
  std::vector<FrameRecord> frames;

  /// The same in all tiles, and of no other map of the city.
  const std::string& map_id() const;
};

/// By the number of the drive in the tile.
/// @throws InputError  if the tables of drives or frames are damaged
std::vector<CityFrames> frames_of_tile(const City& city, const CityTile& tile,
                                       const MapReader& map);

}  // namespace fovea
