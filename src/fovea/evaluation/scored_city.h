// The part of a city around one of its drives, as evaluations take a map.
#pragma once

#include "fovea/city/city.h"
#include "fovea/evaluation/drive_in_city.h"
#include "fovea/evaluation/scored_map.h"

namespace fovea {

/// How far from the path of the drive points are loaded, m: scans are compared as far as that.
inline constexpr double kScoredReach = 60;

/// Reads one tile after the other. The frames are those of the drive, and points of other drives
/// are of frame -1. Local frame: that of the city.
/// @throws InputError  if a tile is damaged, or if there is no point near the drive
ScoredMap load_scored_city(const City& city, const DriveInCity& drive);

}  // namespace fovea
