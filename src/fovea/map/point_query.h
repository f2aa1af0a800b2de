// The points of a map file that pass a query.
#pragma once

#include "fovea/map.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// The points that pass, in the frame `local`, with the origin 0. Of tiles outside the box nothing
/// is read. All points are of one committed state.
/// @throws ConfigError  for conditions that are not understood, or a box without a volume
/// @throws InputError   if the map is damaged there
PointCloud find_points(const MapReader& map, const PointQuery& query);

}  // namespace fovea
