// The submaps of a map file, also of a damaged one.
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "fovea/map/map_file.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/map_records.h"

namespace fovea {

/// The metadata as they are stored.
MapMeta stored_meta(MapFile& file);

/// If damage is reported, each missing submap that has frames gets the pose of its first frame.
/// @param missing  takes the numbers of the submaps that are missing without one
std::vector<SubmapRecord> read_submaps(MapFile& file, std::set<std::size_t>& missing);

}  // namespace fovea
