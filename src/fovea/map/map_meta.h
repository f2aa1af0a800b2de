// What a map's meta data say of where it lies and of the drives it was made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/geometry/geodesy.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Where a map says that its frame `local` begins; nothing if it does not.
std::optional<GeodeticPoint> map_origin(const MapMeta& meta);

/// Edge of a map's tiles, m; InputError if it does not tell one that tiles may have.
double map_tile_size(const MapMeta& meta);

/// Numbers of the cameras that a map was made with; empty if it does not state them.
std::vector<int> mapped_cameras(const MapMeta& meta);

/// One of the drives of a merged map, and what is its own there.
struct MergedDrive {
  std::string digest;  ///< of the map that it was before
  std::string name;    ///< of the drive
  int first_frame = 0, end_frame = 0;
  int frame_shift = 0;  ///< a frame's number here less that in its drive
  int first_submap = 0, end_submap = 0;
};

/// The drives of a map that fovea merge made, in order; empty for any other map. InputError if the
/// tables of drives and submaps are damaged.
std::vector<MergedDrive> merged_drives(const MapReader& map);

}  // namespace fovea
